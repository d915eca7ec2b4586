// The module's one function.
#include <exception>

#include "scenarios/view/view_options.hpp"
#include "scenarios/view/window/viewer.hpp"

extern "C" __attribute__((visibility("default"))) int pitviperView(const pitviper::ViewWish* wish, std::string* problem) {
  using namespace pitviper;
  try {
    const bool scripted = !wish->script.empty();
    GlfwWindow window({wish->width, wish->height, static_cast<float>(wish->scale), "pitviper", scripted});
    Viewer viewer(window, *wish);
    viewer.run();
    return 0;
  } catch (const UserError& e) {
    *problem = e.what();
    return 2;
  } catch (const std::exception& e) {
    *problem = e.what();
    return 1;
  }
}
