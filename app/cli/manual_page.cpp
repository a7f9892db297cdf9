// manual_page.cpp: generates the manual page from the command line's help.
#include "app/cli/manual_page.hpp"

#include <CLI/CLI.hpp>
#include <cctype>
#include <string_view>

#include "app/cli/help_topics.hpp"
#include "app/cli/options/command_tree.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

constexpr std::string_view kSeeAlso = ".SH SEE ALSO\n.BR fakenect (1),\n.BR octovis (1)\n";

/// Escapes text for man(7): no line becomes a request, and a minus stays a minus.
std::string escaped(std::string_view text) {
  std::string result;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
    begins_line = c == '\n';
  }
  return result;
}

std::string usage_of(const CLI::App& command, const std::string& name) {
  std::string usage = ".B " + escaped(name) + "\n";
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) {
      const std::string& word = option->get_name(true);
      usage += ".I " + escaped(option->get_required() ? word : "[" + word + "]") + "\n";
    } else if (option->get_required()) {
      usage += ".BI " + escaped(option->get_name()) + " \" " + escaped(option->get_type_name()) + "\"\n";
    }
  }
  return usage + "[\n.I options\n]\n";
}

std::string options_of(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : options_in_order(command)) {
    if (option->get_name(false, true) == "-h,--help") continue;
    const std::string type = option->get_type_name();
    text += ".TP\n";
    if (option->get_positional())
      text += ".I " + escaped(option->get_name(true)) + "\n";
    else if (type.empty())
      text += ".B " + escaped(option->get_name()) + "\n";
    else
      text += ".BI " + escaped(option->get_name()) + " \" " + escaped(type) + "\"\n";
    text += escaped(option->get_description()) + "\n";
  }
  return text;
}

std::string command_section(const CLI::App& command, const std::string& name) {
  std::string text = ".SS " + escaped(name) + "\n" + escaped(command.get_description()) + "\n";
  const std::vector<const CLI::App*> parts = commands_of(command);
  if (!parts.empty()) {
    for (const CLI::App* part : parts) text += command_section(*part, name + " " + part->get_name());
    return text;
  }
  return text + ".PP\n" + usage_of(command, name) + options_of(command);
}

/// A topic keeps its line breaks.
std::string topic_section(const HelpTopic& topic) {
  std::string title(topic.name);
  for (char& letter : title) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return ".SH " + title + "\n.nf\n" + escaped(topic.text) + ".fi\n";
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  std::string page = ".TH ROOMRADAR 1 \"\" \"roomradar " + std::string(kVersion) + "\" \"User Commands\"\n";
  page +=
      ".SH NAME\nroomradar \\- prescan a room with a Kinect, then run augmented reality in the saved map\n"
      ".SH SYNOPSIS\n.B roomradar\n.I command\n[\n.I arguments\n]\n.SH DESCRIPTION\n" +
      escaped(app.get_description()) +
      "\nResults go to standard output, progress and messages to standard error.\n.SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) page += command_section(*command, command->get_name());
  for (const HelpTopic& topic : help_topics()) page += topic_section(topic);
  return page + std::string(kSeeAlso);
}

}  // namespace roomradar
