// Some of a run's pictures on one sheet.
#include <algorithm>
#include <cmath>

#include "sim/image/draw_text.hpp"
#include "sim/image/png.hpp"
#include "sim/parameters/print.hpp"
#include "sim/stream/picture_sink.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

constexpr Rgb8 kPaper = {22, 24, 29}, kInk = {198, 203, 212};
constexpr int kTile_px = 320, kColumns = 4, kGap_px = 12, kText_px = 15, kLine_px = 24;
constexpr std::size_t kMostTiles = 20;

/// As wide as a tile: the mean of the pixels under each, or the nearest.
Rgb8Image resized(const Rgb8Image& from) {
  const int height = std::max(1, static_cast<int>(std::lround(static_cast<double>(from.height) * kTile_px / from.width)));
  Rgb8Image to(kTile_px, height, kPaper);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < kTile_px; ++x) {
      const int left = x * from.width / kTile_px, right = std::max(left + 1, (x + 1) * from.width / kTile_px);
      const int top = y * from.height / height, bottom = std::max(top + 1, (y + 1) * from.height / height);
      int sum[3] = {0, 0, 0}, count = 0;
      for (int v = top; v < bottom; ++v)
        for (int u = left; u < right; ++u, ++count) {
          const Rgb8 c = from.at(u, v);
          sum[0] += c.r, sum[1] += c.g, sum[2] += c.b;
        }
      to.set(x, y, {static_cast<std::uint8_t>(sum[0] / count), static_cast<std::uint8_t>(sum[1] / count), static_cast<std::uint8_t>(sum[2] / count)});
    }
  return to;
}

class ContactSheets final : public PictureUser {
 public:
  explicit ContactSheets(SinkPlace place) : place_(std::move(place)) {}

  void take(const Frame& frame, const Rgb8Image& picture) override {
    Camera& c = cameras_[frame.camera];
    if (c.seen++ % c.step != 0) return;
    const std::string caption = print("%05d   t = %.3f s", frame.number, frame.time_s);
    c.texts = pictureTexts(frame);
    c.tiles.push_back({caption, resized(picture)});
    if (c.tiles.size() < 2 * kMostTiles) return;
    for (std::size_t i = 1; 2 * i < c.tiles.size(); ++i) c.tiles[i] = std::move(c.tiles[2 * i]);  // the first stays: moved onto itself it would be empty
    c.tiles.resize((c.tiles.size() + 1) / 2);
    c.step *= 2;
  }
  void finish() override {
    for (const auto& [name, c] : cameras_) writePng(fileOf(name, 0), sheetOf(c), c.texts, place_.mayReplace);
  }
  bool takesFirst() const override { return true; }
  std::filesystem::path fileOf(const std::string& camera, int) const override { return place_.folder / contactSheetOf(camera); }

 private:
  struct Tile {
    std::string caption;
    Rgb8Image picture;
  };
  struct Camera {
    std::vector<Tile> tiles;  ///< every step-th
    std::size_t seen = 0, step = 1;
    std::map<std::string, std::string> texts;
  };

  static Rgb8Image sheetOf(const Camera& c) {
    std::vector<const Tile*> chosen;
    const std::size_t count = std::min(c.tiles.size(), kMostTiles);
    for (std::size_t k = 0; k < count; ++k) chosen.push_back(&c.tiles[count < 2 ? 0 : k * (c.tiles.size() - 1) / (count - 1)]);
    const int columns = std::min(kColumns, static_cast<int>(count)), rows = (static_cast<int>(count) + columns - 1) / columns;
    const int height = chosen.front()->picture.height + kLine_px;
    Rgb8Image sheet(columns * (kTile_px + kGap_px) + kGap_px, rows * (height + kGap_px) + kGap_px, kPaper);
    for (std::size_t k = 0; k < count; ++k) {
      const int left = kGap_px + static_cast<int>(k) % columns * (kTile_px + kGap_px), top = kGap_px + static_cast<int>(k) / columns * (height + kGap_px);
      const Rgb8Image& picture = chosen[k]->picture;
      for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) sheet.set(left + x, top + y, picture.at(x, y));
      plainFont().draw(sheet, left, top + picture.height + kText_px + 2, chosen[k]->caption, kText_px, kInk);
    }
    return sheet;
  }

  SinkPlace place_;
  std::map<std::string, Camera> cameras_;
};

}  // namespace

std::string contactSheetOf(const std::string& camera) { return camera + "_sheet.png"; }

std::unique_ptr<PictureUser> contactSheets(const SinkPlace& place) { return std::make_unique<ContactSheets>(place); }

SinkModel sheetSink() {
  std::vector<Parameter> parameters = styleParameters();
  parameters.insert(parameters.begin(), folderParameter());
  return {"sheet", "Up to twenty pictures of each camera, evenly over the run, its first layer, on one sheet, `<camera>_sheet.png`.", parameters,
          [](const Record& r, const Simulation& sim) {
            return [folder = readFolder(r), style = readStyle(r, sim)](const Simulation&, const SinkPlace& run) {
              const SinkPlace place = run.below(folder);
              std::vector<std::unique_ptr<PictureUser>> users;
              users.push_back(contactSheets(place));
              return makePictureSink(style, std::move(users), place);
            };
          }};
}

}  // namespace pitviper
