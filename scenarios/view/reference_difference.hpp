#pragma once
// What a picture is off by: some of its pixels, more and more of them, against the reference at every wavelength in double precision.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/view/picture_maker.hpp"

namespace pitviper {

struct ReferenceDifference {
  std::uint64_t picture = 0;  ///< its number
  int width = 0, height = 0;
  int step = 0;    ///< a pixel of each square of so many is looked at
  int pixels = 0;  ///< so far
  struct Channel {
    std::string name;
    std::vector<float> relative;  ///< [pixel], (drawn - reference) / max(|reference|, 1e-3 of the picture's 99th percentile); NaN where none was looked at yet
    double largest = 0.0, rms = 0.0;
  };
  std::vector<Channel> channels;
};

/// Keeps the reference of a camera from one picture to the next. All on one thread, with a context of its own.
class ReferenceDesk {
 public:
  explicit ReferenceDesk(const ShaderLibrary& library);
  ~ReferenceDesk();
  /// Finer and finer; `tell` gets each. Ends early where it is stale. Null: the picture has no plan's values.
  std::shared_ptr<const ReferenceDifference> look(const ShownPicture& picture, const std::function<bool()>& isStale,
                                                  const std::function<void(std::shared_ptr<const ReferenceDifference>)>& tell);

 private:
  struct Own;
  const ShaderLibrary& library_;
  std::unique_ptr<Own> own_;
};

}  // namespace pitviper
