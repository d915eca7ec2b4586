// Entities, their shapes and surfaces, lights, and where all of them are.
#include <algorithm>
#include <cmath>

#include "materials/lights.hpp"
#include "scenarios/assets/make_aircraft.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/flights.hpp"
#include "scenarios/reader/tables.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/mesh_axes.hpp"
#include "sim/scene/mesh_import.hpp"
#include "sim/scene/mesh_tools.hpp"
#include "sim/scene/placement.hpp"
#include "sim/scene/primitives.hpp"
#include "sim/scene/sea_surface.hpp"

namespace pitviper {

namespace {
/// About 300 MB of vertices and indices.
constexpr std::size_t kMostSceneTriangles = 10000000;
/// A ground's reach unless given: the horizon from 12.5 km up.
constexpr double kUsualGround_m = 4e5;
}  // namespace

int Builder::entityNamed(const Value& asked) const {
  const std::string name = readText(asked, "entity");
  const auto found = entityIndex_.find(name);
  if (found != entityIndex_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [n, i] : entityIndex_) names.push_back(n);
  throw unknownWord(asked.where, "above this place there is no entity", name, names, "add it under 'entities:', a carrier before what it carries");
}

namespace {

/// Whether u and v differ anywhere over a part.
bool hasUv(const Mesh& mesh, size_t part) {
  const MeshPart& p = mesh.parts[part];
  const glm::vec2 first = mesh.uv[mesh.triangles[p.firstTriangle].x];
  for (std::uint32_t t = p.firstTriangle; t < p.firstTriangle + p.triangleCount; ++t)
    for (int k = 0; k < 3; ++k)
      if (mesh.uv[mesh.triangles[t][k]] != first) return true;
  return false;
}

/// Whether a texture of more than one texel says something of a surface.
bool hasPattern(const Simulation& sim, const Surface& s) {
  const Material& m = sim.materialOf(s);
  std::vector<int> textures = m.modifiers;
  textures.push_back(s.temperatureTexture);
  if (m.states) textures.push_back(m.states->texture);
  if (m.given) textures.push_back(m.given->modifier);
  if (m.transmission) textures.push_back(m.transmission->modifier);
  return std::any_of(textures.begin(), textures.end(), [&](int t) { return t >= 0 && sim.textures[static_cast<size_t>(t)].texels.size() > 1; });
}

struct ShapeModel {
  std::vector<std::string> needs, takes;  ///< keys
  Mesh (*make)(const Record&) = nullptr;  ///< null: of more than its keys
};

double given(const Record& r, const char* key) { return r.given(key) ? r.number(key) : 0.0; }
int segments(const Record& r) { return static_cast<int>(r.integer("segments")); }

const std::map<std::string, ShapeModel>& shapeModels() {
  static const std::map<std::string, ShapeModel> all = {
      {"plate", {{"width", "height"}, {}, [](const Record& r) { return makePlate(r.number("width"), r.number("height")); }}},
      {"box", {{"length", "width", "height"}, {}, [](const Record& r) { return makeBox(r.number("length"), r.number("width"), r.number("height")); }}},
      {"disc", {{"radius"}, {"segments"}, [](const Record& r) { return makeDisc(r.number("radius"), segments(r)); }}},
      {"sphere",
       {{"radius"},
        {"segments", "fit"},
        [](const Record& r) {
          return makeSphere(r.number("radius"), segments(r), r.text("fit") == "inscribed" ? SphereFit::Inscribed : SphereFit::EqualArea);
        }}},
      {"ellipsoid",
       {{"length", "width", "height"},
        {"segments"},
        [](const Record& r) { return makeEllipsoid(r.number("length"), r.number("width"), r.number("height"), segments(r)); }}},
      {"cylinder",
       {{"radius", "length"},
        {"segments", "capped"},
        [](const Record& r) { return makeCylinder(r.number("radius"), r.number("length"), segments(r), r.boolean("capped")); }}},
      {"cone",
       {{"radius", "length"},
        {"top_radius", "segments", "capped"},
        [](const Record& r) { return makeCone(r.number("radius"), given(r, "top_radius"), r.number("length"), segments(r), r.boolean("capped")); }}},
      {"jet", {{}, {}, [](const Record&) { return makeJet(); }}},
      {"missile", {{}, {}, [](const Record&) { return makeMissile(); }}},
      {"terrain", {{"size"}, {"relief", "columns", "terrain_seed", "height_map"}}},
      {"sea",
       {{"size", "wind"},
        {"wind_to", "points", "sea_seed", "time"},
        [](const Record& r) {
          SeaPatch sea;
          sea.size_m = r.number("size");
          if (!(sea.size_m >= 0.01 && sea.size_m <= 1e5))
            throw UserError(r.where("size"), "'size' of a sea is " + r.value("size").text.substr(0, 40), "0.01 m to 100 km",
                            "make it smaller and put `ground` beyond");
          r.fill(sea);
          return makeSea(sea).mesh;
        }}},
      {"ground", {{}, {"extent", "tile"}}},
      {"mesh", {{"file", "unit"}, {"forward", "up"}}}};
  return all;
}

/// A key of another shape would be ignored without a word.
void refuseForeignKeys(const Record& r, const std::string& name, const ShapeModel& model) {
  std::vector<std::string> own = model.needs;
  own.insert(own.end(), model.takes.begin(), model.takes.end());
  own.emplace_back("scale");
  for (size_t i = 0; i < r.whole().entries.size(); ++i) {
    const std::string& key = r.whole().entries[i].first;
    if (key != "model" && std::find(own.begin(), own.end(), key) == own.end())
      throw unknownWord(r.whole().keyPlaces[i], "a " + name + " has no", key, own, "remove it");
  }
  for (const std::string& key : model.needs)
    if (!r.given(key)) throw UserError(r.where(), "a " + name + " without '" + key + "'", tables::shape().find(key)->description, "add '" + key + ":'");
}

/// Turns a mesh from a file by its 'forward' and 'up'; what is not given is as the format has it.
void turnAsAsked(Mesh& mesh, const Record& r) {
  const FileAxes usual = usualAxes(r.text("file"));
  FileAxes meant = usual;
  if (r.given("forward")) meant.forward = *axisNamed(r.text("forward"));
  if (r.given("up")) meant.up = *axisNamed(r.text("up"));
  if (meant.forward == meant.up || meant.forward == -meant.up)
    throw UserError(r.where(r.given("up") ? "up" : "forward"), "a body's nose and its upper side point along the same axis of its file",
                    "'forward' and 'up' at right angles",
                    r.given("up") && r.given("forward") ? "change one"
                    : r.given("up")                     ? "add 'forward:'"
                                                        : "add 'up:'");
  turnAxes(mesh, usual, meant);
}

/// The true form, scaled.
BodyForm formOf(const Record& r, const std::string& model) {
  const double scale = r.given("scale") ? r.number("scale") : 1.0;
  auto metres = [&](const char* key) { return scale * given(r, key); };
  if (model == "sphere") return {BodyForm::Kind::Ellipsoid, glm::dvec3(metres("radius"))};
  if (model == "ellipsoid") return {BodyForm::Kind::Ellipsoid, 0.5 * glm::dvec3(metres("length"), metres("width"), metres("height"))};
  const bool closed = r.boolean("capped");
  if (model == "cylinder" && closed) return {BodyForm::Kind::Cone, {0.5 * metres("length"), metres("radius"), metres("radius")}};
  if (model == "cone" && closed) return {BodyForm::Kind::Cone, {0.5 * metres("length"), metres("radius"), metres("top_radius")}};
  return {};
}

}  // namespace

std::shared_ptr<const Mesh> Builder::shapeOf(const Value& value, BodyForm& form) {
  // The same words give the same mesh: bodies that share it are drawn together.
  auto [known, fresh] = shapes_.try_emplace(wordsOf(value));
  if (fresh) known->second.first = readShape(value, known->second.second);
  form = known->second.second;
  return known->second.first;
}

std::shared_ptr<const Mesh> Builder::readShape(const Value& value, BodyForm& form) {
  const Record r(value, tables::shape());
  const std::string model = r.text("model");
  const ShapeModel& shape = shapeModels().at(model);
  refuseForeignKeys(r, model, shape);
  if (const auto points = r.integer("points"); model == "sea" && (points & (points - 1)) != 0)
    throw UserError(r.where("points"), "'points' is " + std::to_string(points), "a power of two, 4 to 2048", "write 'points: 256'");
  form = formOf(r, model);
  auto mesh = std::make_shared<Mesh>();
  if (shape.make) *mesh = shape.make(r);
  else if (model == "terrain") {
    if (r.given("height_map")) {
      const int texture = readTexture(r.value("height_map"), "m", "a height map", -1e4, 1e4);
      const Texture t = std::move(simulation_.textures.back());
      simulation_.textures.resize(static_cast<size_t>(texture));
      if (t.width < 2 || t.height < 2 || t.width > 2048 || t.height > 2048)
        throw UserError(r.where("height_map"), "a height map of " + std::to_string(t.width) + "x" + std::to_string(t.height), "2x2 to 2048x2048", "resize it");
      *mesh = makeTerrain(r.number("size"), t.width - 1, t.height - 1, t.texels);
    } else {
      TerrainShape terrain{.relief_m = 0.0};
      r.fill(terrain);
      *mesh = makeTerrain(terrain);
    }
  } else if (model == "ground") {
    *mesh = makeGround(r.given("extent") ? r.number("extent") : kUsualGround_m, simulation_.frame.earthRadius_m(), given(r, "tile"));
  } else {
    std::filesystem::path path = r.text("file");
    if (path.is_relative()) path = spectra_.files().base / path;
    *mesh = importMesh(path, r.number("unit"), r.where("file"));
    turnAsAsked(*mesh, r);
  }
  if (r.given("scale")) {
    for (auto& p : mesh->positions) p *= static_cast<float>(r.number("scale"));
    mesh->offset_m *= r.number("scale");
  }
  validateMesh(*mesh, r.where());
  return mesh;
}

void Builder::readSurfaces(const Record& r, Entity& entity) {
  struct Given {
    const Value* material = nullptr;
    const Value* temperature = nullptr;
  };
  std::map<std::string, Given> parts;
  std::vector<std::string> names;
  for (const auto& p : entity.mesh->parts) names.push_back(p.name);
  if (r.given("parts")) {
    const Value& map = r.value("parts");
    for (size_t i = 0; i < map.entries.size(); ++i) {
      const auto& [name, value] = map.entries[i];
      if (std::find(names.begin(), names.end(), name) == names.end()) throw unknownWord(map.keyPlaces[i], "this shape has no part", name, names, "remove it");
      const Record part(value, tables::part());
      if (!parts.emplace(name, Given{part.find("material"), part.find("temperature")}).second)
        throw UserError(map.keyPlaces[i], "a second entry for part '" + name + "'", "one", "remove one");
    }
  }
  std::map<const Value*, int> materials, textures;  // one value gives one material, however many parts share it
  for (size_t i = 0; i < entity.mesh->parts.size(); ++i) {
    const Given own = parts.count(names[i]) ? parts[names[i]] : Given{};
    const Value* material = own.material ? own.material : r.find("material");
    const Value* temperature = own.temperature ? own.temperature : r.find("temperature");
    if (!material || !temperature)
      throw UserError(r.where(), "part '" + names[i] + "' of '" + entity.name + "' has no " + (material ? "temperature" : "material"),
                      "one for the part or for the whole entity", material ? "add 'temperature: 300 K'" : "add 'material: <name>'");
    Surface s;
    s.meshPart = static_cast<std::uint32_t>(i);
    if (!materials.count(material)) materials[material] = materialNamed(*material);
    s.material = materials[material];
    if (temperature->kind == Value::Kind::Map && !isCourse(*temperature) && !isRecovery(*temperature)) {
      if (!textures.count(temperature)) textures[temperature] = readTexture(*temperature, "K", "temperature", 0.0, 1e5);
      s.temperatureTexture = textures[temperature];
      const auto& texels = simulation_.textures[static_cast<size_t>(s.temperatureTexture)].texels;
      double mean = 0.0;
      for (float t : texels) mean += static_cast<double>(t);
      s.temperature_K = mean / static_cast<double>(texels.size());
      const auto [low, high] = std::minmax_element(texels.begin(), texels.end());
      checkTemperatures(s.material, static_cast<double>(*low), static_cast<double>(*high), temperature->where);
    } else {
      readTemperature(*temperature, static_cast<int>(simulation_.entities.size()), static_cast<int>(i), s);
    }
    if (hasPattern(simulation_, s) && !hasUv(*entity.mesh, i))
      throw UserError(s.temperatureTexture >= 0 ? temperature->where : material->where,
                      "a texture on part '" + names[i] + "' of '" + entity.name + "', which has no texture coordinates: all of it would get one texel",
                      "a shape with u and v (of a mesh: in its file, at every face), or a number instead of the texture",
                      "unwrap the mesh and export it with its u,v, or take the texture off this part");
    entity.surfaces.push_back(s);
  }
}

void Builder::checkMedium(const Record& r, const Entity& e) const {
  const auto material = [&](const Surface& s) { return simulation_.materials[static_cast<size_t>(s.material)]; };
  const auto filled = std::find_if(e.surfaces.begin(), e.surfaces.end(), [&](const Surface& s) { return material(s)->medium.has_value(); });
  if (filled == e.surfaces.end()) return;
  const std::string name = "'" + e.name.substr(0, 60) + "'";
  for (const Surface& s : e.surfaces) {
    if (s.material != filled->material || s.temperature_K != filled->temperature_K || s.temperature != filled->temperature)
      throw UserError(r.where("parts"), "the parts of " + name + " differ, and '" + material(*filled)->name.substr(0, 60) + "' is a medium",
                      "one material and temperature for a body that a medium fills", "remove 'parts', or make two entities of it");
    if (s.temperatureTexture >= 0)
      throw UserError(r.where("temperature"), "a temperature texture on " + name + ", which a medium fills", "one temperature for the whole body",
                      "write a number, such as '900 K'");
  }
  if (!e.mesh->closed)
    throw UserError(r.where("shape"), "the body of " + name + " is not closed, and '" + material(*filled)->name.substr(0, 60) + "' is a medium that fills it",
                    "a body whose every edge joins two triangles, with its normals outwards",
                    "take a sphere, ellipsoid, box, or a capped cone or cylinder; or close the mesh");
}

void Builder::readEntities(const Record& scenario) {
  if (!scenario.given("entities")) return;
  std::size_t triangles = 0;
  for (const Value& v : scenario.value("entities").items) {
    const Record r(v, tables::entity());
    Entity e;
    r.fill(e);
    checkUnique(r.value("name"), entityNames_, "entity");
    e.mesh = shapeOf(r.value("shape"), e.form);
    if (const Record shape(r.value("shape"), tables::shape()); shape.text("model") == "mesh") {
      e.meshFile = shape.text("file");
      e.metresPerUnit = shape.number("unit") * (shape.given("scale") ? shape.number("scale") : 1.0);
    }
    triangles += e.mesh->triangles.size();
    if (triangles > kMostSceneTriangles)
      throw UserError(r.where("shape"), "the scene has more than " + std::to_string(kMostSceneTriangles) + " triangles with this body", "fewer",
                      "simplify meshes, or lower 'segments' and 'columns'");
    readSurfaces(r, e);
    checkMedium(r, e);
    const Placement p = readPlacement(r, Mover::Entity);
    e.motion = p.motion;
    e.parent = p.carrier;
    e.lifetime = p.lifetime;
    e.flight = p.flight;
    if (p.fliesLater) fliesLater_[static_cast<int>(simulation_.entities.size())] = &v;
    const BoundingSphere sphere = boundingSphere(*e.mesh);
    e.boundingCentre = glm::vec3(sphere.center);
    e.boundingRadius_m = static_cast<float>(sphere.radius_m);
    entityIndex_[e.name] = static_cast<int>(simulation_.entities.size());
    simulation_.entities.push_back(std::move(e));
  }
  flyAll();
  readRecoveries();
}

/// Further points of lights come after all others, which commands number.
void Builder::readLights(const Record& scenario) {
  if (!scenario.given("lights")) return;
  std::vector<PointLight> further;
  for (const Value& v : scenario.value("lights").items) {
    const LightModel& model = askedLight(v);
    const ParameterTable table = tables::light(model);
    const Record r(v, table);
    PointLight l;
    r.fill(l);
    checkUnique(r.value("name"), lightNames_, "light");
    const auto spectra =
        spectraOf(model.parameters, r, [&](const Value& s, const Parameter& p) { return bounded(spectra_, s, p.unit, p.key, p.minimum, p.maximum); });
    model.make({r, spectra}, l);
    const Mover mover = model.hasAxes ? Mover::Beam : Mover::Light;
    Placement p = readPlacement(r, mover);
    if (p.fliesLater) flyNow(r, mover, p);
    l.mount.motion = p.motion;
    l.mount.carrier = p.carrier;
    l.lifetime = p.lifetime;
    if (model.hasAxes) readLookAt(r, "light", l.mount);
    const Spectrum whole = l.intensity;
    const int lamp = static_cast<int>(simulation_.lights.size());
    for (const LightPoint& point : model.points ? model.points(r) : std::vector<LightPoint>()) {
      l.offset_m = point.offset_m;
      l.intensity = whole * point.share;
      if (l.lamp < 0) simulation_.lights.push_back(l);
      else further.push_back(l);
      l.lamp = lamp;
    }
    if (l.lamp < 0) simulation_.lights.push_back(std::move(l));
  }
  simulation_.lights.insert(simulation_.lights.end(), further.begin(), further.end());
}

}  // namespace pitviper
