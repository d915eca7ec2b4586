#pragma once
// What a pixel of a shown picture is made of, by the reference, with its spectrum.
#include <memory>
#include <optional>
#include <string>

#include "scenarios/view/picture_maker.hpp"
#include "sim/frame/pixel_parts.hpp"

namespace pitviper {

struct PixelProbe {
  std::uint64_t picture = 0;  ///< its number
  int column = 0, row = 0;
  PixelParts parts;
  std::optional<PixelSpectrum> spectrum;  ///< over the band asked for
};

struct PixelProbeWish {
  ShownPicturePointer picture;
  int column = 0, row = 0;
  double low_um = 0.0, high_um = 0.0;  ///< of the spectrum; equal: none is wanted
};

/// Keeps the reference of a camera from one pixel to the next. All on one thread, with a context of its own.
class PixelProbeDesk {
 public:
  explicit PixelProbeDesk(const ShaderLibrary& library);
  ~PixelProbeDesk();
  /// `tell` gets the parts before the spectrum is there. Null: of a file, whose scenario is not known.
  std::shared_ptr<const PixelProbe> look(const PixelProbeWish& wish, const std::function<bool()>& isStale,
                                         const std::function<void(std::shared_ptr<const PixelProbe>)>& tell);

 private:
  struct Own;
  const ShaderLibrary& library_;
  std::unique_ptr<Own> own_;
};

}  // namespace pitviper
