#include "sim/render/media/field_draws.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

/// Edge of a tile [pixels]: lists stay short, which leaves rounds for more lines at a nozzle, and few pixels wait for a neighbour's. Larger where a picture
/// would have too many.
constexpr int kTile_px = 4, kMostTilesAcross = 128;
/// A field whose depth is less than this part of the way to it has one stretch of air across it: as kEven of its shader.
constexpr double kEven = 0.1;
/// Many pixels of a zoomed view are one of the film's: lines through each may lie farther apart.
constexpr double kOfMany = 2.0;
/// Elements that the lines of a pixel look up in all, and as many more of each step: at a nozzle more lines would cost a frame more than its picture gains (a
/// duel of two jets a half).
constexpr double kMostWork = 30000.0, kOfStep = 3.0;
/// Pixels finer than lines through their middles that may have so much. Where there are fewer, each may have more, by the square: few of those that stand in
/// tiles with something fine want many lines, and a flare far off is one pixel that wants thousands.
constexpr double kFullPixels = 1024.0;

std::uint32_t bitsOf(double v) { return std::bit_cast<std::uint32_t>(static_cast<float>(v)); }
/// Units of tiles and of lines.
constexpr unsigned kTiles = 19, kLines = 16;

}  // namespace

FieldDraws::FieldDraws(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, const ShaderSlots& slots)
    : sampling_(FieldSampling::of(simulation, plan)), entries_(simulation.fields.size(), 0) {
  for (const FieldBody& field : simulation.fields) {
    Body& body = bodies_.emplace_back(simulation, plan, field);
    ShaderSlots own = slots;
    own.files["field"] = field.source->shader();
    own.constants["MIXTURES"] = body.tables.mixtures;
    own.constants["LEVEL_FOURS"] = body.tables.levelFours;
    own.constants["FOURS"] = body.tables.fours;
    own.constants["SCATTERS"] = body.tables.scatters ? 1 : 0;
    own.constants["DROPS"] = body.tables.drops ? 1 : 0;
    for (const bool even : {false, true}) {
      own.constants["EVEN"] = even ? 1 : 0;
      std::string key = field.source->shader() + (even ? " far" : " near");
      for (const char* name : {"MIXTURES", "LEVEL_FOURS", "SCATTERS", "DROPS"}) key += " " + std::to_string(own.constants[name]);
      auto [at, isNew] = programs_.try_emplace(key);
      if (isNew)
        at->second = Program(assembleShader(library, "sim/render/media/glsl/listed.vert.glsl", own),
                             assembleShader(library, "sim/render/media/glsl/volume_field.frag.glsl", own));
      (even ? body.far : body.near) = &at->second;
    }
  }
}

void FieldDraws::place(const View& view, const WorldState& state) {
  const glm::dmat3 cameraFromLocal = glm::transpose(view.localFromCamera);
  for (size_t f = 0; f < bodies_.size(); ++f) {
    Body& body = bodies_[f];
    const FieldState* field = fieldOf(state, f);
    body.lines = {};
    body.state = field && !field->elements.empty() ? field : nullptr;
    if (!body.state) continue;
    body.steps = sampling_->steps(f, state.time_s), body.coarser = sampling_->coarser(f, state.time_s);
    body.lines = fieldLines(view, *field);
    if (body.lines.isEmpty()) continue;
    if (body.uploaded != field->texels) {
      body.texels.upload(field->texels->texel);
      body.uploaded = field->texels;
    }
    if (body.tables.mix(field->share)) body.spectra.upload(body.tables.texels);
    const glm::dmat3 fieldFromCamera = glm::transpose(field->localFromField) * view.localFromCamera;
    const glm::dvec3 origin = cameraFromLocal * (field->origin - view.position);
    for (int r = 0; r < 3; ++r) body.draw.row[r] = glm::vec4(fieldFromCamera[0][r], fieldFromCamera[1][r], fieldFromCamera[2][r], origin[r]);
    body.draw.fine.x = static_cast<float>(origin.z - static_cast<double>(static_cast<float>(origin.z)));
    double nearest = INFINITY, farthest = 0.0;
    for (const FieldElement& e : field->elements) {
      const double to = glm::length(field->origin + field->localFromField * e.centre - view.position);
      nearest = std::min(nearest, to - e.radius_m);
      farthest = std::max(farthest, to + e.radius_m);
    }
    body.range = farthest - nearest < kEven * nearest ? glm::vec2(nearest, farthest) : glm::vec2(0.0f);
  }
}

bool FieldDraws::isEmpty() const {
  return std::all_of(bodies_.begin(), bodies_.end(), [](const Body& b) { return b.lines.isEmpty(); });
}

void FieldDraws::addDraws(std::vector<GpuDraw>& draws) const {
  for (const Body& body : bodies_) draws.push_back(body.draw);
}

void FieldDraws::look(const View& view) {
  for (Body& body : bodies_) {
    body.lines = {};
    body.listed.clear();
    if (!body.state) continue;
    body.lines = fieldLines(view, *body.state);
    if (!body.lines.isEmpty()) listTiles(view, body);
  }
  listLines(view);
}

void FieldDraws::listTiles(const View& view, Body& body) const {
  const glm::ivec2 low(glm::floor(body.lines.low)), high = glm::min(glm::ivec2(glm::ceil(body.lines.high)), glm::ivec2(view.width, view.height));
  const glm::ivec2 size = glm::max(high - low, glm::ivec2(1));
  const int side = std::max(kTile_px, (std::max(size.x, size.y) + kMostTilesAcross - 1) / kMostTilesAcross);
  const glm::ivec2 tiles = (size + side - 1) / side;
  body.grid = {low.x, low.y, tiles.x, side};
  body.listed.assign(static_cast<size_t>(tiles.x) * static_cast<size_t>(tiles.y), {});
  const FieldState& field = *body.state;
  const glm::dvec3 along = -view.localFromCamera[2];
  for (const FieldLines::Part& part : body.lines.parts) {
    const FieldElement& e = field.elements[part.element];
    const int steps = body.steps[static_cast<size_t>(e.kind)];
    if (steps == 0) continue;
    const double depth = glm::dot(field.localFromField * e.centre, along);
    const glm::ivec2 first = glm::clamp((glm::ivec2(glm::floor(part.low)) - low) / side, glm::ivec2(0), tiles - 1);
    const glm::ivec2 last = glm::clamp((glm::ivec2(glm::ceil(part.high)) - low) / side, glm::ivec2(0), tiles - 1);
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        Tile& tile = body.listed[static_cast<size_t>(y * tiles.x + x)];
        const glm::dvec2 range(depth - e.radius_m, depth + e.radius_m);
        tile.range = tile.texel.empty() ? range : glm::dvec2(std::min(tile.range.x, range.x), std::max(tile.range.y, range.y));
        if (const auto texel = static_cast<std::uint32_t>(e.texel); tile.texel.empty() || tile.texel.back() != texel) tile.texel.push_back(texel);
        tile.lines.parts.push_back(part);
        tile.lines.parts.back().coarser = body.coarser[static_cast<size_t>(e.kind)];
        tile.lines.apart_px = std::min({tile.lines.apart_px, part.apart_px.x, part.apart_px.y});
        tile.steps = std::max(tile.steps, steps);
      }
  }
  std::vector<std::uint32_t> words(5 * body.listed.size());
  for (size_t t = 0; t < body.listed.size(); ++t) {
    const Tile& tile = body.listed[t];
    const std::uint32_t row[5] = {static_cast<std::uint32_t>(words.size()), static_cast<std::uint32_t>(tile.texel.size()),
                                  static_cast<std::uint32_t>(tile.steps), bitsOf(tile.range.x), bitsOf(tile.range.y)};
    std::copy_n(row, 5, &words[5 * t]);
    words.insert(words.end(), tile.texel.begin(), tile.texel.end());
  }
  body.tiles.upload(words);
}

const FieldDraws::Tile* FieldDraws::Body::tileAt(int x, int y) const {
  if (listed.empty()) return nullptr;
  const int column = x - grid.x, row = y - grid.y;
  if (column < 0 || row < 0 || column >= grid.z * grid.w) return nullptr;
  const auto t = static_cast<size_t>(row / grid.w * grid.z + column / grid.w);
  return t < listed.size() && !listed[t].texel.empty() ? &listed[t] : nullptr;
}

/// Lines that a pixel may have, each way; those of a zoomed view's share what one of the film may, and have one at least.
int FieldDraws::mostAt(int x, int y) const {
  double most = kReferenceLines;
  for (const Body& body : bodies_)
    if (const Tile* tile = body.tileAt(x, y)) {
      const double listed = static_cast<double>(tile->texel.size()), work = listed + tile->steps * (kOfStep + listed);
      most = std::min(most, std::max(std::floor(std::sqrt(mostWork_ / (work * shared_))), 1.0));
    }
  return static_cast<int>(most);
}

/// Of every pixel the lines through all fields that it may show, so that what is in each other is met by the same ones.
void FieldDraws::listLines(const View& view) {
  entries_.assign(bodies_.size(), 0);
  glm::ivec2 low(view.width, view.height), high(0);
  for (size_t f = 0; f < bodies_.size(); ++f) {
    if (!shows(f)) continue;
    const glm::ivec4 rect = rectOf(f);
    low = glm::min(low, glm::ivec2(rect)), high = glm::max(high, glm::ivec2(rect) + glm::ivec2(rect.z, rect.w));
  }
  low = glm::max(low, glm::ivec2(0)), high = glm::min(high, glm::ivec2(view.width, view.height));
  part_ = {low, glm::max(high - low, glm::ivec2(0))};
  double fine = 0.0;  // pixels
  for (const Body& body : bodies_)
    for (const Tile& tile : body.listed)
      if (tile.lines.apart_px < 1.0) fine += body.grid.w * body.grid.w;
  const double few = std::max(kFullPixels / std::max(fine, 1.0), 1.0);
  mostWork_ = kMostWork * few * few;
  shared_ = view.zoomed ? std::max(view.pixelTan2 / (view.tanPerPixelX * view.tanPerPixelY), 1.0) : 1.0;
  std::vector<std::uint32_t> words(static_cast<size_t>(part_.z) * static_cast<size_t>(part_.w), 0);
  std::vector<size_t> here;
  std::vector<const FieldLines*> lists;
  PixelLines lines;
  const auto add = [&](int x, int y) {
    std::uint32_t& at = words[static_cast<size_t>(y - low.y) * static_cast<size_t>(part_.z) + static_cast<size_t>(x - low.x)];
    if (at != 0) return;
    here.clear(), lists.clear();
    double finest = 1.0;
    for (size_t f = 0; f < bodies_.size(); ++f)
      if (const Tile* tile = bodies_[f].tileAt(x, y)) {
        here.push_back(f), lists.push_back(&tile->lines);
        finest = std::min(finest, tile->lines.apart_px);
      }
    if (finest < 1.0) lines = pixelLines(lists, x, y, mostAt(x, y), view.zoomed ? LinesApart{kOfMany, 1} : LinesApart{});
    else lines.outside = 0.0, lines.within.assign(1, {glm::dvec2(x, y) + 0.5, 1.0});
    at = static_cast<std::uint32_t>(words.size());
    const auto count = static_cast<std::uint32_t>(lines.within.size());
    words.insert(words.end(), {count, bitsOf(lines.outside)});
    for (const FilmLine& line : lines.within) words.insert(words.end(), {bitsOf(line.at.x), bitsOf(line.at.y), bitsOf(line.share)});
    for (size_t f : here) entries_[f] += count;
  };
  for (const Body& body : bodies_)
    for (size_t t = 0; t < body.listed.size(); ++t) {
      if (body.listed[t].texel.empty()) continue;
      const glm::ivec2 corner = glm::ivec2(body.grid) + body.grid.w * glm::ivec2(static_cast<int>(t) % body.grid.z, static_cast<int>(t) / body.grid.z);
      const glm::ivec2 from = glm::max(corner, low), to = glm::min(corner + body.grid.w, high);
      for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) add(x, y);
    }
  if (words.empty()) words.push_back(0);
  lines_.upload(words);
}

glm::ivec4 FieldDraws::rectOf(size_t field) const {
  const FieldLines& lines = bodies_[field].lines;
  const glm::ivec2 low(glm::floor(lines.low)), high(glm::ceil(lines.high));
  return {low.x, low.y, high.x - low.x, high.y - low.y};
}

void FieldDraws::setTiles(size_t field, const Program& program) const {
  const Body& body = bodies_[field];
  body.tiles.bindTexture(kTiles, 1, true);
  glUniform4i(program.uniform("tileGrid"), body.grid.x, body.grid.y, body.grid.z, body.grid.w);
}

void FieldDraws::setLines(const Program& program) const {
  lines_.bindTexture(kLines, 1, true);
  glUniform4i(program.uniform("linesPart"), part_.x, part_.y, part_.z, part_.w);
}

void FieldDraws::reserve() {
  for (Body& body : bodies_)
    for (Buffer* each : {&body.spectra, &body.texels, &body.tiles}) each->reserve(sizeof(glm::vec4));
  lines_.reserve(sizeof(std::uint32_t));
  entries_.assign(bodies_.size(), 0);
}

const Program& FieldDraws::program(size_t field, bool even) const {
  const Body& body = bodies_[field];
  return even ? *body.far : *body.near;
}

void FieldDraws::bind(size_t field) const {
  const Body& body = bodies_[field];
  body.tiles.bindTexture(kTiles, 1, true);
  lines_.bindTexture(kLines, 1, true);
  body.spectra.bindTexture(5, 4);
  body.texels.bindTexture(17, 4);
}

void FieldDraws::setUniforms(size_t field, const Program& program) const {
  const Body& body = bodies_[field];
  setTiles(field, program);
  setLines(program);
  glUniform2f(program.uniform("fieldRange"), body.range.x, body.range.y);
  glUniform4fv(program.uniform("gasLevels"), static_cast<GLsizei>(body.tables.temperatures.size()), &body.tables.temperatures[0].x);
  glUniform4f(program.uniform("planckRange"), body.tables.firstInverse_K, body.tables.entriesPerInverse, static_cast<float>(body.tables.blackAt),
              static_cast<float>(body.tables.blackEntries - 1));
}

void FieldDraws::addPrograms(std::vector<NamedProgram>& all) const {
  for (const auto& [key, program] : programs_) all.push_back({"field " + key, program.text()});
}

}  // namespace pitviper
