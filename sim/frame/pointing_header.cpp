#include "sim/frame/pointing_header.hpp"

namespace pitviper {

void addPointing(Frame& frame, const CameraPointing& pointing) {
  const auto add = [&](const char* name, auto value) { frame.attributes.push_back({std::string("pitviper.gimbal.") + name, value}); };
  const auto both = [](const glm::dvec2& v) { return std::vector<double>{v.x, v.y}; };
  const Followed& f = pointing.followed;
  add("driver", f.driver);
  add("mode", f.mode);
  add("locked", static_cast<int>(f.locked));
  add("angles_rad", both(f.angle_rad));
  if (f.rate_rad_s) add("rates_rad_s", both(*f.rate_rad_s));
  if (pointing.target_px) add("target_px", both(*pointing.target_px));
  if (!pointing.tracked) return;
  const Tracked& t = *pointing.tracked;
  add("found", static_cast<int>(t.found));
  if (!t.found) return;
  add("centroid_px", both(t.at_px));
  add("track_error_px", glm::length(t.fromAxis_px));
  add("signal", t.signal);
  add("background", t.background);
  add("threshold", t.threshold);
  add("pixels", t.pixels);
  add("saturated", t.saturated);
}

}  // namespace pitviper
