#include "scenarios/view/frame_files.hpp"

#include "sim/frame/read_frame.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {

bool namesFrames(const std::filesystem::path& word) {
  std::error_code ignored;
  if (std::filesystem::is_directory(word, ignored)) return true;
  const std::string extension = word.extension().string();
  return !extension.empty() && extension != ".yaml" && extension != ".yml";
}

ShownPicturePointer readShownFrame(const FrameFileWish& wish) {
  auto picture = std::make_shared<ShownPicture>();
  picture->frame = readFrame(wish.file);
  picture->tier = Tier::File;
  picture->number = wish.number;
  if (wish.beside.empty()) return picture;
  const Frame other = readFrame(wish.beside);
  const std::vector<FrameLayer> own = picture->frame.layers;
  for (const FrameLayer& layer : own) {
    const auto same = std::find_if(other.layers.begin(), other.layers.end(), [&](const FrameLayer& l) { return l.name == layer.name; });
    if (same == other.layers.end()) continue;
    const FrameDifference d = differenceOf(other, picture->frame, layer.name);
    const std::string name = "less " + wish.beside.filename().string() + ": " + layer.name;
    picture->frame.layers.push_back({name, layer.unit, d.pixels});
    picture->frame.attributes.push_back({name, print("rms %.4g %s, largest %.4g at %d, %d; of the value there: rms %.3g %%, largest %.3g %%", d.rms,
                                                     layer.unit.c_str(), d.largest, d.column, d.row, 100.0 * d.rmsRelative, 100.0 * d.largestRelative)});
  }
  return picture;
}

std::string bodyNamed(const Frame& frame, int entity) {
  for (const Attribute& a : frame.attributes)
    if (a.name == "entity." + std::to_string(entity) + ".name")
      if (const auto* text = std::get_if<std::string>(&a.value)) return *text;
  return "";
}

std::vector<std::pair<std::string, std::string>> wordsOf(const Frame& frame) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const Attribute& a : frame.attributes) {
    if (a.name.rfind("unit.", 0) == 0) continue;
    if (const auto* text = std::get_if<std::string>(&a.value)) {
      all.emplace_back(a.name, *text);
    } else if (const auto numbers = numbersOf(a)) {
      std::string list;
      constexpr std::size_t kShown = 6;
      for (std::size_t k = 0; k < std::min(numbers->size(), kShown); ++k) list += (k > 0 ? " " : "") + print("%.9g", (*numbers)[k]);
      if (numbers->size() > kShown) list += print(" ... %zu numbers", numbers->size());
      all.emplace_back(a.name, list);
    }
  }
  return all;
}

}  // namespace pitviper
