// command_tree.cpp: one table per command: groups in the order of the help, and two examples.
#include "app/cli/options/command_tree.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace roomradar {
namespace {

struct OptionGroup {
  const char* title;
  std::vector<const char*> options;
};

struct CommandHelp {
  const char* command;  ///< name, or the names of command and part
  std::vector<OptionGroup> groups;
  const char* examples;
};

/// Returns the groups and examples of all commands. One table, so it is not split.
std::vector<CommandHelp> command_helps() {
  return {
      {"start",
       {{"Options", {"--ui-scale"}}},
       "  roomradar start maps/kitchen\n  roomradar start recordings/kitchen maps/kitchen\n"},
      {"prescan",
       {{"Everyday options",
         {"--map", "--window", "--resume", "--replace", "--preset", "--report", "--trajectory"}},
        {"Source and window", {"--frames", "--calibration", "--poses", "--ui-scale", "--lost-signal"}},
        {"What the recording does not state",
         {"--depth-unit", "--camera", "--poses-convention", "--stamps", "--depth-topic"}},
        {"World", {"--up"}},
        {"Accuracy, time and memory",
         {"--resolution", "--deviation", "--tracking-px", "--fuse-every", "--max-fused", "--texture",
          "--max-memory", "--presets"}},
        {"Interruption and measurement", {"--checkpoint-every", "--hold-out"}}},
       "  roomradar prescan kinect:0 --map maps/kitchen\n"
       "  roomradar prescan 'sim:table?frames=200' --map maps/table --report prescan.json\n"},
      {"run",
       {{"Everyday options", {"--map", "--window", "--object", "--script", "--video", "--report"}},
        {"Source and window", {"--frames", "--calibration", "--poses", "--at-end", "--ui-scale"}},
        {"What the recording does not state",
         {"--depth-unit", "--camera", "--poses-convention", "--stamps", "--depth-topic"}},
        {"Objects", {"--objects", "--object-size", "--object-up"}},
        {"What objects touch", {"--surfaces", "--unknown", "--commit-changes", "--save-map"}},
        {"Files written",
         {"--trajectory", "--stream", "--pictures", "--pictures-stride", "--record-session", "--frames-csv",
          "--verbose"}},
        {"Accuracy and time",
         {"--budget-ms", "--max-memory", "--preset", "--presets", "--depth-stride", "--tracking-px",
          "--verify-every", "--mesh-tolerance-sigmas", "--fine-mesh", "--radar", "--radar-px",
          "--physics-step", "--move-every", "--object-error", "--soft-edges", "--bridge-gaps", "--shadows",
          "--shadow-every", "--picture-every"}}},
       "  roomradar run kinect:0 --map maps/kitchen --window\n"
       "  roomradar run RECORDING --map maps/kitchen --object chair.glb --video ar.mp4 --report run.json\n"},
      {"check",
       {{"Options", {"--json"}},
        {"What the recording does not state",
         {"--depth-unit", "--camera", "--poses-convention", "--stamps", "--depth-topic"}}},
       "  roomradar check recordings/kitchen\n  roomradar check phone.bag --json | jq .input\n"},
      {"map info",
       {{"Options", {"--json"}}},
       "  roomradar map info maps/kitchen\n  roomradar map info maps/kitchen --json | jq .surfaces\n"},
      {"map verify",
       {},
       "  roomradar map verify maps/kitchen\n  for m in maps/*/; do roomradar map verify \"$m\"; done\n"},
      {"map export",
       {{"Options", {"--unknown"}}},
       "  roomradar map export maps/kitchen kitchen.html\n"
       "  roomradar map export maps/kitchen kitchen.bt    # for octovis\n"},
      {"map objects",
       {},
       "  roomradar map objects maps/kitchen\n"
       "  roomradar map objects maps/kitchen rename object pot\n"},
      {"map log",
       {{"Options", {"--json"}}},
       "  roomradar map log maps/kitchen\n"
       "  roomradar run kinect:0 --map maps/kitchen@2    # the room as it was\n"},
      {"map restore", {}, "  roomradar map restore maps/kitchen@2\n"},
      {"map undo", {}, "  roomradar map undo maps/kitchen\n"},
      {"map prune", {{"Options", {"--keep"}}}, "  roomradar map prune maps/kitchen --keep 10\n"},
      {"map list",
       {{"Options", {"--json"}}},
       "  roomradar map list maps\n  roomradar map list backup/maps --json | jq -r '.maps[].name'\n"},
      {"map copy",
       {},
       "  roomradar map copy maps/kitchen maps/kitchen-before\n"
       "  roomradar map copy maps/kitchen /media/stick/kitchen\n"},
      {"map rename",
       {},
       "  roomradar map rename maps/room-2026-12-01 maps/kitchen\n"
       "  roomradar map rename ~/.local/share/Trash/files/kitchen maps/kitchen    # out of the trash\n"},
      {"map delete",
       {{"Options", {"--for-good"}}},
       "  roomradar map delete maps/kitchen\n  roomradar map delete maps/kitchen --for-good\n"},
      {"map pack",
       {},
       "  roomradar map pack maps/kitchen kitchen.rrm\n"
       "  for m in maps/*/; do roomradar map pack \"$m\" \"backup/$(basename \"$m\").rrm\"; done\n"},
      {"map unpack",
       {{"Options", {"--map"}}},
       "  roomradar map unpack kitchen.rrm\n  roomradar map unpack kitchen.rrm --map maps/kitchen\n"},
      {"map merge",
       {{"Options", {"--map", "--deviation", "--report"}}},
       "  roomradar map merge maps/monday maps/tuesday --map maps/both\n"
       "  roomradar map merge maps/kitchen maps/hall --map maps/flat --report merge.json\n"},
      {"map diff",
       {{"Options", {"--html", "--picture", "--report"}}},
       "  roomradar map diff maps/monday maps/tuesday\n"
       "  roomradar map diff maps/monday maps/tuesday --html changes.html\n"},
      {"building",
       {{"Options", {"--recordings", "--poses", "--processes", "--report"}},
        {"Accuracy and tiles", {"--resolution", "--tile-edge", "--deviation"}}},
       "  roomradar building buildings/museum --recordings recordings.txt\n"
       "  roomradar building buildings/museum --recordings recordings.txt --resolution 0.02 --processes 8\n"
       "where recordings.txt holds, for instance:\n"
       "  hall: recordings/hall\n"
       "  stairs: recordings/stairs\n"},
      {"record",
       {{"Options", {"--format", "--frames", "--calibration"}},
        {"What the recording does not state",
         {"--depth-unit", "--camera", "--poses-convention", "--stamps", "--depth-topic"}}},
       "  roomradar record kinect:0 recordings/kitchen\n"
       "  roomradar record 'sim:table?frames=100' recordings/table --format 7scenes\n"},
      {"simulate",
       {{"Options", {"--room", "--frames", "--path", "--moving", "--walks", "--seed", "--format"}}},
       "  roomradar simulate recordings/table --room table --frames 600\n"
       "  roomradar simulate recordings/hand --path view --moving hand,ball\n"
       "  roomradar simulate recordings/office --room 'building?rooms=40&width=320' --walks 0:19\n"},
      {"calibrate",
       {{"Everyday options", {"--out", "--square", "--columns", "--rows", "--plot"}},
        {"Source and report", {"--frames", "--report"}}},
       "  roomradar calibrate recordings/board --square 0.03 --out kinect.json --plot kinect.png\n"
       "  roomradar calibrate 'sim:board?path=swing&colour=separate&faults=1&frames=800&rate=15' --square "
       "0.06 \\\n"
       "      --out kinect.json\n"},
      {"doctor", {}, "  roomradar doctor\n  roomradar doctor || echo something must be repaired\n"},
      {"fallthrough",
       {{"Everyday options", {"--scenarios", "--radar", "--html", "--report"}},
        {"Scenarios", {"--seed", "--random-rooms", "--threads", "--maps", "--csv", "--scenario", "--video"}},
        {"Jobs", {"--jobs", "--job-size", "--processes", "--part", "--rows"}},
        {"A map instead of scenarios",
         {"--map", "--reference", "--poses", "--frames", "--calibration", "--cell", "--picture"}}},
       "  roomradar fallthrough --scenarios 100 --html fallthrough.html\n"
       "  roomradar fallthrough RECORDING --map maps/kitchen --picture floor.png\n"},
      {"serve",
       {{"Options", {"--listen", "--anchor", "--verbose"}},
        {"Other machines", {"--allow-remote", "--token-file"}}},
       "  roomradar serve maps/kitchen buildings/museum\n"
       "  roomradar serve buildings/museum --anchor 48.137,11.575,520,90 --listen 127.0.0.1:9000\n"
       "  roomradar serve buildings/museum --listen 0.0.0.0:8080 --allow-remote --token-file token\n"},
      {"farm",
       {{"Options", {"--out", "--processes", "--job", "--emit", "--report"}}},
       "  roomradar farm rooms.txt --out results\n"
       "  roomradar farm rooms.txt --out results --emit slurm > submit.sh\n"
       "where rooms.txt holds, for instance:\n"
       "  morning: prescan recordings/morning --map {}/map\n"
       "  evening: prescan recordings/evening --map {}/map\n"
       "  changes: map diff {morning}/map {evening}/map --html {}/changes.html\n"},
      {"trade",
       {{"Everyday options", {"--quick", "--html", "--presets", "--report"}},
        {"What is measured",
         {"--rooms", "--only", "--settings", "--repeats", "--objects", "--seed", "--time"}},
        {"More", {"--csv", "--compare-published"}},
        {"Jobs", {"--jobs", "--processes", "--setting", "--rows"}}},
       "  roomradar trade --quick --html trade.html\n"
       "  roomradar trade RECORDING --rooms none --jobs sweep --html accuracy.html\n"
       "  roomradar trade RECORDING --settings 50 --html trade.html --presets presets.json\n"},
  };
}

CLI::App* command_of_path(CLI::App& app, const std::string& path) {
  const std::size_t blank = path.find(' ');
  CLI::App* command = command_named(app, path.substr(0, blank));
  if (command == nullptr || blank == std::string::npos) return command;
  return command_named(*command, path.substr(blank + 1));
}

/// CLI11's help with the options in the groups of the table. Omits the types of positional arguments, and the
/// ranges, which the messages for wrong values state.
class HelpFormatter final : public CLI::Formatter {
 public:
  explicit HelpFormatter(std::vector<OptionGroup> groups = {}) : groups_(std::move(groups)) {
    column_width(32);
  }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) +
           make_option_groups(*app) + make_subcommands(app, mode) + "\n" + make_footer(app);
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_positional()) return {};
    std::string type = option->get_type_name();
    for (const char* range : {":INT", ":FLOAT", ":{"}) type = type.substr(0, type.find(range));
    return type.empty() ? "" : " " + type;
  }
  std::string make_footer(const CLI::App* app) const override {
    const std::string footer = app->get_footer();
    return footer.empty() ? "" : "Examples:\n" + footer;
  }

 private:
  std::vector<OptionGroup> groups_;

  [[nodiscard]] std::string make_option_groups(const CLI::App& app) const {
    std::vector<const CLI::Option*> left = app.get_options(
        [](const CLI::Option* option) { return option->nonpositional() && !option->get_group().empty(); });
    std::string text;
    for (const OptionGroup& group : groups_) {
      std::vector<const CLI::Option*> options;
      for (const char* name : group.options) {
        const auto found = std::find_if(left.begin(), left.end(),
                                        [&](const auto* option) { return option->check_name(name); });
        if (found == left.end()) continue;
        options.push_back(*found);
        left.erase(found);
      }
      if (!options.empty()) text += make_group(group.title, false, options);
    }
    return left.empty() ? text : text + make_group(groups_.empty() ? "Options" : "Other", false, left);
  }
};

}  // namespace

std::vector<const CLI::Option*> options_in_order(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  const bool is_part = parent != nullptr && parent->get_parent() != nullptr;
  const std::string path = (is_part ? parent->get_name() + " " : "") + command.get_name();
  std::vector<std::string> names;
  for (const CommandHelp& help : command_helps())
    if (help.command == path)
      for (const OptionGroup& group : help.groups)
        names.insert(names.end(), group.options.begin(), group.options.end());
  const auto rank = [&](const CLI::Option* option) {
    if (option->get_positional()) return std::ptrdiff_t{-1};
    return std::find_if(names.begin(), names.end(),
                        [&](const std::string& name) { return option->check_name(name); }) -
           names.begin();
  };
  std::vector<const CLI::Option*> options =
      command.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
  std::stable_sort(options.begin(), options.end(),
                   [&](const auto* a, const auto* b) { return rank(a) < rank(b); });
  return options;
}

void arrange_help(CLI::App& app) {
  app.formatter(std::make_shared<HelpFormatter>());
  for (const CommandHelp& help : command_helps()) {
    CLI::App* command = command_of_path(app, help.command);
    if (command == nullptr) continue;
    command->formatter(std::make_shared<HelpFormatter>(help.groups));
    command->footer(help.examples);
  }
}

}  // namespace roomradar
