// calibrate_command.cpp: roomradar calibrate: cameras and depth errors from a recording of a checkerboard.
#include "app/commands/commands.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "app/calibration/calibrate.hpp"
#include "app/calibration/calibration_plot.hpp"
#include "app/sources/formats/median.hpp"
#include "app/cli/deferred_errors.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/open_source.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "app/media/picture_file.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kMostViews = 100;

/// Medians over the held-out views.
struct Summary {
  double colour_px, depth_bias_m, depth_rms_m;
};
Summary summary_of(const std::vector<ViewResidual>& residuals, const std::vector<std::size_t>& of) {
  std::vector<double> colour_px, bias_m, rms_m;
  for (const std::size_t i : of) {
    colour_px.push_back(residuals[i].colour_rms_px);
    bias_m.push_back(std::abs(residuals[i].depth_bias_m));
    rms_m.push_back(residuals[i].depth_rms_m);
  }
  return {median_of(colour_px), median_of(bias_m), median_of(rms_m)};
}

nlohmann::json summary_json(const Summary& summary) {
  return {{"colour_rms_px", summary.colour_px},
          {"depth_bias_m", summary.depth_bias_m},
          {"depth_rms_m", summary.depth_rms_m}};
}

void print_camera(const char* name, const Intrinsics& said, const Intrinsics& camera, const Lens& lens,
                  double focal_sigma_px, double centre_sigma_px) {
  std::printf("%-7s f %.2f %.2f +- %.2f px (declared %.2f), c %.2f %.2f +- %.2f px (declared %.2f %.2f)\n",
              name, camera.fx_px, camera.fy_px, focal_sigma_px, said.fx_px, camera.cx_px, camera.cy_px,
              centre_sigma_px, said.cx_px, said.cy_px);
  std::printf("        lens k1 %.4f k2 %.4f p1 %.5f p2 %.5f k3 %.4f\n", lens.k1, lens.k2, lens.p1, lens.p2,
              lens.k3);
}

void print_fit(const BoardViews& views, const CalibrationFit& fit, const Summary& before,
               const Summary& after) {
  const Calibration& found = fit.calibration;
  std::printf("%lld frames, %zu views of the board, %zu of them held out\n",
              static_cast<long long>(views.frames), views.views.size(), fit.held_out.size());
  print_camera("colour", views.first.colour_camera, *found.rig.colour_camera, found.colour_lens,
               fit.sigmas.colour_focal_px, fit.sigmas.colour_centre_px);
  print_camera("depth", views.first.depth_camera, found.rig.depth_camera, found.depth_lens,
               fit.sigmas.depth_focal_px, fit.sigmas.depth_centre_px);
  const Eigen::Vector3d shift = found.rig.T_colour_depth.translation();
  std::printf("depth to colour %.2f %.2f %.2f +- %.2f mm, turned by %.3f +- %.3f deg\n", 1e3 * shift.x(),
              1e3 * shift.y(), 1e3 * shift.z(), 1e3 * fit.sigmas.shift_m,
              Eigen::AngleAxisd(found.rig.T_colour_depth.linear()).angle() * 180.0 / M_PI,
              fit.sigmas.turn_rad * 180.0 / M_PI);
  std::printf("inverse depth scale %.4f\n", found.depth_correction.inverse_scale);
  std::printf("held-out views      before      after  (medians)\n");
  std::printf("corners, RMS     %7.3f px %7.3f px\n", before.colour_px, after.colour_px);
  std::printf("depth, bias      %7.2f mm %7.2f mm\n", 1e3 * before.depth_bias_m, 1e3 * after.depth_bias_m);
  std::printf("depth, RMS       %7.2f mm %7.2f mm\n", 1e3 * before.depth_rms_m, 1e3 * after.depth_rms_m);
}

/// Returns the number of views, how many are tilted, and what is missing.
std::string progress_note(const BoardViews& views, const Board& board) {
  const std::string advice = advice_on(views, board);
  const std::size_t count = views.views.size();
  return std::to_string(count) + (count == 1 ? " view, " : " views, ") + std::to_string(count_tilted(views)) +
         " tilted" + (advice.empty() ? "" : "; " + advice);
}

/// At the first colour image, prints that both cameras count as one if the depth is registered to the colour.
void say_if_registered(const BoardViews& views, bool& was_said) {
  if (was_said || views.first.colour.empty()) return;
  was_said = true;
  if (is_registered(views.first))
    std::fprintf(
        stderr,
        "roomradar: the depth is registered to the colour image, so both cameras count as one; for a "
        "Kinect's own two cameras record kinect:N without ?depth=registered, or sim:board with "
        "colour=separate\n");
}

/// Warns if the depth scale is suspicious. Only the squares' size sets the scale: a board printed at 97 %
/// yields a camera that measures 3 % too far.
void say_if_scaled(double inverse_scale, double square_m) {
  constexpr double kMost = 0.02;
  if (std::abs(inverse_scale - 1.0) <= kMost) return;
  std::fprintf(stderr,
               "roomradar: the estimated depth scale is %+.1f %% off; if the squares are not %g m, measure "
               "one and give its side with --square\n",
               100.0 * (inverse_scale - 1.0), square_m);
}

}  // namespace

int run(const CalibrateOptions& options) {
  Report report;
  report.command = "calibrate";
  report.source = options.source;
  report.settings = {{"columns", options.board.columns},
                     {"rows", options.board.rows},
                     {"square_m", options.board.square_m},
                     {"calibration", options.calibration}};
  if (options.frames) report.settings["frames"] = {options.frames->first, options.frames->last};
  require_valid(options.board);
  require_png_name(options.plot);
  for (const std::string& path : {options.calibration, options.plot, options.report}) require_writable(path);

  SourceOptions source_options;
  source_options.as_recorded = true;  // ignores an existing calibration
  const Interrupt interrupt;
  std::unique_ptr<FrameSource> source =
      ended_by_interrupt(open_source(options.source, options.frames, {}, source_options));
  BoardViews views;
  bool was_said = false;
  {
    Progress progress("looking for the board", source->frame_count());
    views = report.times.timed("views", [&] {
      return find_board_views(*source, options.board, kMostViews, [&](const BoardViews& found) {
        say_if_registered(found, was_said);
        progress.step(progress_note(found, options.board));
      });
    });
  }
  source.reset();  // stops the device
  report.frames_read = views.frames;
  const CalibrationFit fit =
      report.times.timed("fit", [&] { return calibrate(views, {.board = options.board}); });

  const Summary before = summary_of(fit.before, fit.held_out);
  const Summary after = summary_of(fit.after, fit.held_out);
  print_fit(views, fit, before, after);
  say_if_scaled(fit.calibration.depth_correction.inverse_scale, options.board.square_m);
  report.results = {{"views", views.views.size()},
                    {"held_out_views", fit.held_out.size()},
                    {"inverse_depth_scale", fit.calibration.depth_correction.inverse_scale},
                    {"before", summary_json(before)},
                    {"after", summary_json(after)}};
  DeferredErrors faults;
  faults.attempt([&] { write_calibration(fit.calibration, options.calibration); });
  faults.attempt([&] {
    if (!options.plot.empty()) write_png(calibration_plot(views, fit), options.plot);
  });
  faults.attempt([&] { write_report(report, options.report); });
  faults.throw_first();
  return 0;
}

}  // namespace roomradar
