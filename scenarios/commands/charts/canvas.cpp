#include "scenarios/commands/charts/canvas.hpp"

#include <vtkCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkWindowToImageFilter.h>

#include <cstring>
#include <stdexcept>

#include "scenarios/commands/charts/style.hpp"
#include "sim/gl/context.hpp"

namespace pitviper {
namespace {

using namespace chart_style;

/// Keeps VTK's complaints instead of printing them. That GLEW was not initialised is none: without an X display it stops after it has
/// found every OpenGL function, and says so.
class Complaints final : public vtkCommand {
 public:
  static Complaints* New() { return new Complaints; }
  void Execute(vtkObject*, unsigned long, void* data) override {
    const char* message = static_cast<const char*>(data);
    if (message != nullptr && std::strstr(message, "GLEW could not be initialized") == nullptr) text += message;
  }
  std::string text;
};

/// A chart looks the same on every machine where Mesa's own renderer can be had; elsewhere any driver will do.
GlContext chartContext() {
  try {
    return GlContext("surfaceless");
  } catch (const GlError&) {
    return GlContext("auto");
  }
}

/// The mean of kOversampling^2 drawn pixels; VTK's rows begin at the bottom.
Rgb8Image averaged(vtkImageData& drawn, int width, int height) {
  Rgb8Image picture(width, height, {});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int j = 0; j < kOversampling; ++j)
          for (int i = 0; i < kOversampling; ++i)
            sum += static_cast<const unsigned char*>(drawn.GetScalarPointer(x * kOversampling + i, (height - 1 - y) * kOversampling + j, 0))[c];
        constexpr int kCount = kOversampling * kOversampling;
        picture.rgb[picture.offset(x, y) + static_cast<size_t>(c)] = static_cast<std::uint8_t>((sum + kCount / 2) / kCount);
      }
  return picture;
}

}  // namespace

Rgb8Image drawnOffScreen(int width, int height, const std::function<void(vtkRenderer&)>& fill) {
  if (width > 16384 / kOversampling || height > 16384 / kOversampling) throw std::invalid_argument("too large a picture");
  const GlContext context = chartContext();
  vtkNew<Complaints> complaints;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  window->AddObserver(vtkCommand::ErrorEvent, complaints);
  window->SetReadyForRendering(true);
  window->SetOwnContext(0);
  window->SetIsCurrent(true);
  window->SetMultiSamples(4);
  window->SetSize(width * kOversampling, height * kOversampling);
  window->OpenGLInitContext();

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  window->AddRenderer(renderer);
  fill(*renderer);
  window->Render();
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ShouldRerenderOff();
  grab->ReadFrontBufferOff();
  grab->Update();
  vtkImageData* drawn = grab->GetOutput();
  if (!complaints->text.empty()) throw std::runtime_error(complaints->text);
  const int* size = drawn->GetDimensions();
  if (size[0] != width * kOversampling || size[1] != height * kOversampling || drawn->GetNumberOfScalarComponents() < 3)
    throw std::runtime_error("the picture that VTK gave back has another size");
  Rgb8Image picture = averaged(*drawn, width, height);
  window->Finalize();
  return picture;
}

}  // namespace pitviper
