// scan_window.cpp: shows the window, and runs the scan on another thread.
#include "app/window/scan/scan_window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <csignal>
#include <exception>
#include <memory>
#include <thread>

#include "app/window/glfw_window.hpp"
#include "app/window/imgui_window.hpp"
#include "app/window/scan/scan_ui.hpp"

namespace roomradar {

ScanWindowResult run_in_scan_window(const std::string& title, std::optional<double> ui_scale,
                                    LostSignal lost_signal, const std::function<int(ScanChannel&)>& work) {
  ScanWindowResult result;
  const std::shared_ptr<GlfwWindow> window = open_window(title);
  ScanChannel channel([] { glfwPostEmptyEvent(); });
  std::exception_ptr fault;
  std::thread scan([&] {
    try {
      result.status = work(channel);
    } catch (const std::exception& error) {
      fault = std::current_exception();
      channel.finish({error.what()});
    }
    if (channel.requested() == ScanRequest::kDiscard)
      glfwSetWindowShouldClose(window->get(), GLFW_TRUE);  // allowed on any thread
    glfwPostEmptyEvent();
  });
  show_until_closed(*window, ui_scale, [&](const look::Fonts& fonts) {
    return std::make_unique<ScanUi>(channel, fonts, lost_signal);
  });
  channel.set_paused(false);
  if (channel.outcome().text.empty() && channel.requested() == ScanRequest::kGoOn) std::raise(SIGINT);
  result.wants_to_play = channel.requested() == ScanRequest::kPlay;
  if (!result.wants_to_play) glfwHideWindow(window->get());  // the work may take a while to end
  scan.join();
  // The program closed the window after a discarded scan; the user did not.
  if (channel.requested() == ScanRequest::kDiscard) glfwSetWindowShouldClose(window->get(), GLFW_FALSE);
  if (fault) std::rethrow_exception(fault);
  if (result.wants_to_play) result.window = window;
  return result;
}

}  // namespace roomradar
