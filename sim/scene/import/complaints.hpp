#pragma once
// Takes what VTK would print. Observing ErrorEvent on a reader would miss the objects it uses inside.
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <string>

#include "sim/parameters/error.hpp"

namespace pitviper {

class Complaints : public vtkOutputWindow {
 public:
  static Complaints* New();
  vtkTypeMacro(Complaints, vtkOutputWindow) void DisplayText(const char* text) override { note(text); }
  void DisplayErrorText(const char* text) override { note(text); }
  void DisplayWarningText(const char* text) override { note(text); }
  void DisplayGenericWarningText(const char* text) override { note(text); }
  void DisplayDebugText(const char*) override {}

  std::string first;

 private:
  /// Keeps what follows the source's file name and the object's address: "ERROR: In F, line N\nvtkX (0x..): what".
  void note(const char* text) {
    if (!first.empty() || text == nullptr) return;
    first = text;
    if (const std::size_t object = first.find("): "); object != first.npos) first.erase(0, object + 3);
    while (!first.empty() && static_cast<unsigned char>(first.back()) <= 32) first.pop_back();
    if (first.empty()) first = "unknown error";
  }
};

/// Where the XML parser stopped, if that is what is said: "Error parsing XML in stream at line 7, column 3, ...".
Location placeIn(const std::string& file, const std::string& complaint);

}  // namespace pitviper
