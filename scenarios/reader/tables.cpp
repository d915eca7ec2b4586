#include "scenarios/reader/tables.hpp"

#include "atmosphere/clouds.hpp"
#include "atmosphere/models.hpp"
#include "materials/angle_tables.hpp"
#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "scenarios/reader/cumuli.hpp"
#include "scenarios/reader/flares.hpp"
#include "scenarios/reader/flights.hpp"
#include "scenarios/reader/plumes.hpp"
#include "scenarios/reader/smokes.hpp"
#include "sensors/gimbal/gimbal_choice.hpp"
#include "sensors/quantity.hpp"
#include "sensors/stages.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/scene/placement.hpp"
#include "sim/scene/primitives.hpp"
#include "sim/scene/sea_surface.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper::tables {
namespace {

constexpr double kHalfTurn = 3.14159265358979324;
/// Beyond any fireball; spectral radiance is then far from the end of a float.
constexpr double kHottest_K = 1e5;

const std::vector<std::string> kAxes = {"+x", "-x", "+y", "-y", "+z", "-z"};

/// Where something is: shared by entities, lights and cameras.
void addPlacement(std::vector<Parameter>& p, bool attitude, double mostTurn = kMostTurn_rad) {
  for (auto& own : positionParameters()) p.push_back(std::move(own));
  if (attitude)
    for (auto& own : attitudeParameters(mostTurn)) p.push_back(std::move(own));
  p.push_back(
      any("motion",
          "waypoints, whose orientation follows the path unless a waypoint gives one; or a map with `model`: waypoints, route, csv, ballistic or missile"));
  p.push_back(withDefault(choice("interpolation", {"smooth", "linear"}, "between waypoints: cubic with continuous velocity, or straight"), "smooth"));
  p.push_back(any("ends", "what its motion does before its first and after its last point: hold, go_on, loop or vanish, or a map of `before` and `after`"));
  p.push_back(map("spin", "turning about an axis of its own, on top of its attitude"));
  p.push_back(text("attached_to",
                   "name of an entity that carries it: positions are then in that body's axes. A camera does not see its carrier: attach one behind a dome to "
                   "the aircraft, not to the dome"));
}

/// From when to when it is there.
void addLifetime(std::vector<Parameter>& p) {
  p.push_back(within(number("begin", "s", "from then on it is there: seen, in the way of light, casting shadows; always unless given", &Lifetime::begin_s),
                     -kLongestTime_s, kLongestTime_s));
  p.push_back(within(number("end", "s", "at that time it no longer is", &Lifetime::end_s), -kLongestTime_s, kLongestTime_s));
}

/// A spectrum over view angle: emissivity, transmittance.
std::vector<Parameter> overView(const std::string& what) {
  return {spectrum(what, "", "at normal view, 0..1"),
          list("angular", "rows [angle, factor]: " + what + " over view angle divided by that at normal", 1, 1024),
          list("wavelength", "of a table instead: rising wavelengths", 1, 1024),
          list("angles", "of a table: one axis, `{angle: view, count: 3, last: 90 deg}`; held beyond its last", 1, 1),
          list("values", "of a table: " + what + " 0..1, nested as values[angle][wavelength]", 2, 1024),
          map("modifier", "texture that multiplies it, 0..1")};
}

}  // namespace

const ParameterTable& scenario() {
  static const ParameterTable t{
      "scenario",
      "The file itself.",
      {text("name", "short name, written into every frame (default: the file's name)", &Simulation::name),
       text("description", "one or two sentences"),
       text("extends",
            "a scenario whose keys hold where this one has none: the same scene with other cameras. A path relative to this file, within the folder above its "
            "own, in a folder of `--root` or in a library; files that it names are found from its own folder"),
       any("include",
           "a file, or a list of files, whose keys are put under this one's: maps key by key, own keys first; lists joined, the included first (not `sinks`). "
           "Below the scenario's folder, in a folder of `--root` or in a library"),
       map("parameters", "name: value, for `$name` anywhere else in this file and in those that it includes here"),
       withDefault(integer("seed", "seed of everything random", 0, 9007199254740991LL, &Simulation::seed), "1"),
       map("origin", "where the local east-north-up frame stands on the earth"),
       any("refraction",
           "how the air bends light: `none` (unless given), `standard`, by the air's own density or 0.163 where it does not say, or a map with `coefficient`"),
       map("time", "first frame, rate and number of frames"),
       map("limits", "what may come besides the scenario's own times, where poses and levels come live"),
       map("render", "how it is drawn"),
       any("accuracy",
           "relative error of a pixel that the plan may spend on wavelengths, tables and terms left out, `1 %` for example, or `reference`: every wavelength "
           "in double precision on the CPU, slow; `none`: as each camera's `spectral` says, nothing left out; without it: 1 % in layered air and air from "
           "tables, else none. A map says besides what a stream may fall back to: `{asked: 1 %, at_most: 3 %}`"),
       within(number("audit", "",
                     "pixels a frame that are worked out by the reference as well, and held against it: 0.1 is one in each tenth frame, 0 none; without it as "
                     "many as cost about a twentieth of the time",
                     &Simulation::audit),
              0.0, 1e6),
       any("atmosphere", "the air: `none`, the name of a library air, or a map"),
       map("wind", "where the air goes to, for what flies in it"),
       map("background", "what is behind everything (0 K unless given), seen through the air"),
       map("ground", "the earth's surface where bodies end: under layered air it is always there, black unless this says otherwise"),
       map("sun", "direction and irradiance"),
       boolean("stars", "the brightest stars, V to 2.5, by `time: {date}` and `origin` at frame 0, where cameras see them"),
       map("ambient", "what lights all surfaces from all around"),
       map("materials", "name: material; library materials need not be listed"),
       list("lights", "spectral point lights", 0, 1024),
       list("entities", "bodies", 0, 4096),
       list("plumes", "exhaust of engines, motors and nozzles", 0, 256),
       list("smokes", "trails of smoke, let out by bodies or at places", 0, 256),
       list("flares", "decoys that entities eject: a light, a burning cloud, smoke", 0, 256),
       list("clouds", "cumulus clouds, lit by sun, sky and ground", 0, 64),
       list("cameras", "sensors", 0, 64),
       list("probes", "irradiance meters", 0, 256),
       list("commands", "changes from a time on: bodies moved, cameras turned, temperatures, lights", 0, 4096),
       list("sinks", "where frames go; `[files]` unless given", 1, 64)}};
  return t;
}

const ParameterTable& entryOfList() {
  static const ParameterTable t{
      "entry of a list",
      "Any entry that is a map, as of `entities`, `lights`, `cameras`, `channels`, `motion`.",
      {map("repeat", "the entry stands several times"),
       text("include", "the entries of a file stand here: those of its list, or the one that its map is; beside it nothing but `with` and `repeat`"),
       map("with", "name: value, parameters of that file")}};
  return t;
}

const ParameterTable& repeat() {
  static const ParameterTable t{
      "repeat",
      "An entry as often as it says. Names that do not hold the number get `_0`, `_1`, ...",
      {required(integer("count", "how often; 0: never", 0, 4096)), withDefault(text("as", "the name of its number, from 0: `$i`"), "i"),
       map("every",
           "what is added from each to the next, in the form of the entry: `{position: [10 m, 0 m, 0 m], motion: {time: 0.3 s}}`; keys that the entry has")}};
  return t;
}

const ParameterTable& render() {
  static const ParameterTable t{
      "render",
      "Pictures are the same in either mode, to rounding.",
      {withDefault(choice("mode", {{"auto", RenderMode::Auto}, {"direct", RenderMode::Direct}, {"buffered", RenderMode::Buffered}},
                          "direct: shading integrates straight into the channels; buffered: through a spectral image, as "
                          "transparent things need it; auto: buffered only in frames with something transparent in view",
                          &Simulation::mode),
                   "auto"),
       withDefault(boolean("shadows", "opaque surfaces cast shadows of the sun and of point lights, cumulus clouds of the sun", &Simulation::shadows),
                   "true")}};
  return t;
}

const ParameterTable& origin() {
  static const ParameterTable t{"origin", "", geodeticParameters()};
  return t;
}

const ParameterTable& refraction() {
  static const ParameterTable t{
      "refraction",
      "With it lines of sight go over an earth of radius R / (1 - k), so that horizons lie farther and far things stand higher; lines in layered air follow "
      "its "
      "density, towards space too; sun and moon by date stand at their apparent places.",
      {required(within(number("coefficient", "",
                              "k = -R dn/dh near the ground: 0.13 over warm ground by day, 0.163 in the standard atmosphere, more at night "
                              "and over cold water; 0: true radius, for eyes above some 10 km"),
                       -2.0, 0.9))}};
  return t;
}

const ParameterTable& geodetic() {
  static const ParameterTable t{"geodetic", "A position on the earth.", origin().parameters};
  return t;
}

const ParameterTable& time() {
  static const ParameterTable t{"time",
                                "",
                                {withDefault(within(number("start", "s", "time of frame 0", &TimeAxis::start_s), -kLongestTime_s, kLongestTime_s), "0 s"),
                                 withDefault(within(number("rate", "Hz", "frames per second"), 1e-6, 1e9), "30 Hz"),
                                 withDefault(integer("frames", "number of frames", 1, 10000000, &TimeAxis::frames), "1"),
                                 text("date", "UTC of time 0, such as 2026-06-21T12:00:00, for the headers of frames")}};
  return t;
}

const ParameterTable& limits() {
  static const ParameterTable t{
      "limits",
      "What the plan for an `accuracy` must hold for besides what the scenario's own times show. Frames beyond it say so (`pitviper.outside_limits`).",
      {list("range", "[nearest, farthest] between a camera and a body in view, such as [100 m, 20 km]", 2, 2),
       list("temperature", "[coldest, hottest] of a body, such as [250 K, 900 K]; temperature textures count as they are", 2, 2),
       within(above(number("light", "", "greatest level of a point light", &Limits::lightLevel), 0.0), 0.0, 1e6)}};
  return t;
}

const ParameterTable& accuracy() {
  static const ParameterTable t{
      "accuracy",
      "What a stream may trade for its rate: it begins with the accuracy asked for, draws coarser where it would be late, in steps of two, and "
      "says so on each frame; plans and programs for all of them are made before the first frame. Whatever is not a stream draws as asked.",
      {text("asked", "as `accuracy` itself; unless given 1 %, or `at_most` if that is less"), required(text("at_most", "the coarsest, such as 3 %"))}};
  return t;
}

const ParameterTable& airLibrary() {
  static const ParameterTable t = [] {
    ParameterTable own = anyAirTable();
    own.title = "air (library file)";
    own.description = "atmosphere/library/<name>.yaml: the keys of any of these airs.";
    std::erase_if(own.parameters, [](const Parameter& p) { return p.key == "library"; });
    own.parameters.insert(own.parameters.begin(), {text("description", "what air it is"), text("source", "where the figures come from")});
    return own;
  }();
  return t;
}

const ParameterTable& background() {
  static const ParameterTable t{
      "background", "One of the two.", {within(number("temperature", "K", "black body"), 0, kHottest_K), spectrum("radiance", "W/(m2 sr um)", "radiance")}};
  return t;
}

const ParameterTable& ground() {
  static const ParameterTable t{
      "ground",
      "The sphere at `height` that stands for the earth, where lines of sight end that meet no body and go down (beyond the edge of a terrain too). Lit by "
      "the sun and ambient light; bodies cast no shadows on it, lamps do not light it. With it, or under air with a top, the earth hides the sun.",
      {any("material", "a name, or a material written out, opaque and without textures; black unless given"),
       within(number("temperature", "K", "that of the air there (homogeneous air: its own) unless given"), 0, kHottest_K),
       withDefault(within(number("height", "m", "of the ground above the ellipsoid: layered air stands on it, its haze from there on"), -500, 5000), "0 m")}};
  return t;
}

const ParameterTable& sun() {
  static const ParameterTable t{
      "sun",
      "A directional light: irradiance, or a black body's temperature and solid angle. Where it stands: azimuth and elevation, or by the "
      "scenario's `time: {date}` and `origin`, at frame 0 and for all of the scenario.",
      {within(number("azimuth", "rad", "clockwise from north"), -2 * kHalfTurn, 2 * kHalfTurn),
       within(number("elevation", "rad", "above the horizon"), -kHalfTurn / 2, kHalfTurn / 2),
       withDefault(choice("body", {"sun", "moon"},
                          "moon, by date: what it sends of the sun's light by its phase (ROLO); `irradiance` and `temperature` are the "
                          "sun's at 1 au for both"),
                   "sun"),
       spectrum("irradiance", "W/(m2 um)", "on a plane facing the sun, above the air (at the scene where the air has no top); by date: at 1 au"),
       within(number("temperature", "K", "black body sun; 5772 K with the default solid angle gives 1361 W/m2"), 1, kHottest_K),
       withDefault(within(above(number("solid_angle", "sr", "of the black body sun"), 0), 0, 2 * kHalfTurn), "6.7943e-5 sr")}};
  return t;
}

const ParameterTable& ambient() {
  static const ParameterTable t{
      "ambient",
      "One of these. `temperature` and `radiance` light from everywhere alike; the others by direction: a plan tells them by their mean or by 9, 16 or 25 "
      "spherical "
      "harmonics, with what these leave of the mirrored direction, and says what that loses; the reference takes all of it. Bodies do not hide it from each "
      "other.",
      {within(number("temperature", "K", "black dome"), 0, kHottest_K), spectrum("radiance", "W/(m2 sr um)", "radiance"),
       choice("from", {"sky"},
              "layered air: its sky by elevation and azimuth and the ground below, as seen at each body's height: emission of the air, sunlight it "
              "scatters, the background; the ground in the sun and under the mean sky, seen through the air"),
       list("gradient", "light by elevation alone, linear between entries, held beyond the first and the last", 1, 64),
       map("map", "a picture of all directions")}};
  return t;
}

const ParameterTable& gradientEntry() {
  static const ParameterTable t = [] {
    ParameterTable own{"gradient entry", "An elevation, and a temperature or a radiance. Two at one elevation are a step.", background().parameters};
    own.parameters.insert(own.parameters.begin(),
                          required(within(number("elevation", "rad", "above the horizon; entries rise"), -kHalfTurn / 2, kHalfTurn / 2)));
    return own;
  }();
  return t;
}

const ParameterTable& environmentMap() {
  static const ParameterTable t{
      "map",
      "An EXR of all directions, in layers by wavelength, or in red, green and blue (layers R, G, B), which are raised to spectra under the main light.",
      {required(text("file", "EXR file: its display window; what its data window leaves out of that sends nothing")),
       withDefault(
           choice("layout", {"latitude_longitude", "cube"},
                  "latitude_longitude: rows from zenith to nadir, the middle column towards `heading`, to the right clockwise; cube: six square faces in a "
                  "row: ahead, right, behind, left, up, down, seen from within, up at their tops (of up: behind; of down: ahead)"),
           "latitude_longitude"),
       withDefault(within(number("heading", "rad", "of the middle column or the first face, clockwise from north"), -2 * kHalfTurn, 2 * kHalfTurn), "0 deg"),
       withDefault(within(number("scale", "", "of its values"), 0.0, 1e9), "1"),
       spectrum("light", "W/(m2 sr um)", "main light of a map in colours: what a pixel of (1, 1, 1) sends; such a map has light from 0.36 to 0.83 um"),
       list("layers", "layers by wavelength, in W/(m2 sr um), linear between; no light is known beyond the first and the last", 2, 256)}};
  return t;
}

const ParameterTable& environmentLayer() {
  static const ParameterTable t{"map layer",
                                "A layer of an environment map.",
                                {required(text("name", "its name in the file")), required(within(number("wavelength", "um", "that it is at"), 0.1, 1000.0))}};
  return t;
}

const ParameterTable& material() {
  static const ParameterTable t{
      "material",
      "A surface: reflection components, an emission and a transmission; or a medium that fills a closed body, by `medium` (below). Also the form of "
      "materials/library/<name>.yaml.",
      {text("description", "what it is"), text("source", "where the figures come from"),
       text("file", "instead of all others: a YAML file with the material; what it names is relative to it"),
       list("components", "reflection components; none: black", 0, 64),
       list("temperatures", "instead of components: the surface at rising temperatures, between which it is linear; its own temperature picks", 2, 64),
       map("emission", "given emissivity; without it 1 - reflectance - transmittance (Kirchhoff)"),
       map("transmission", "what is behind is seen through it; needs buffered mode"), text("medium", "what fills the body: then the keys below"),
       any("absorption", "of a gas, see below"), any("radiance", "of a gas, see below")}};
  return t;
}

const ParameterTable& temperatureState() {
  static const ParameterTable t{"material temperature",
                                "A surface at a temperature: what it emits is 1 - reflectance there. All have the same models in the same order.",
                                {required(within(number("temperature", "K", "of the surface"), 1.0, 1e5)),
                                 required(list("components", "reflection components, without textures; none: black", 0, 16))}};
  return t;
}

const MediumModel* mediumOf(const Value& value) {
  const MediumModel* medium = value.kind == Value::Kind::Map ? askedMedium(value) : nullptr;
  if (const Value* radiance = value.find("radiance"); radiance && !medium)
    throw UserError(radiance->where, "a material with 'radiance' that is no medium", "'absorption' beside it, or no 'radiance'",
                    "add 'absorption: 0.1 /m', or remove it");
  for (const char* key : {"components", "temperatures", "emission", "transmission"})
    if (const Value* given = value.find(key); given && medium)
      throw UserError(given->where, std::string("a medium with '") + key + "'", "a surface, or a medium",
                      "remove it, or what makes it a medium; a body with both is two entities");
  return medium;
}

ParameterTable medium(const MediumModel& model) {
  ParameterTable t{"material: " + model.name,
                   model.description,
                   {text("medium", "`" + model.name + "`" + (model.name == "gas" ? ", or left out" : "")), material().parameters[0], material().parameters[1]}};
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  return t;
}

const ParameterTable& texture() {
  static const ParameterTable t{
      "texture",
      "A grey PNG (8 or 16 bit, read linearly), a layer of an OpenEXR file, or inline rows, bottom row last, stretched over u and v from 0 to 1; bilinear "
      "between pixel centres. "
      "Where an accuracy is asked for it is read over what a pixel covers of it, and a temperature gives the mean of what that sends.",
      {text("file",
            "PNG or EXR file; an EXR's values are in the texture's unit (K, um, or 1). Its display window counts: what its data window leaves out "
            "is 0 of a share (a modifier), and refused of anything else"),
       text("layer", "of an EXR file with several"), list("rows", "rows of numbers from top to bottom", 1, 4096),
       any("minimum", "of a PNG file: value of black (a quantity in the texture's unit)"), any("maximum", "of a PNG file: value of white"),
       withDefault(choice("edges", {"hold", "repeat"}, "beyond its edges; repeat where it goes round a sphere or cylinder (u runs round, v from end to end)"),
                   "hold")}};
  return t;
}

const ParameterTable& emission() {
  static const ParameterTable t{
      "emission",
      "A spectrum and a factor over view angle, or a table over both. Pictures hold view angles every 0.5 deg, or finer (to 0.0625 deg) where that hits all "
      "the "
      "angles given, and are linear between; a bend that no such step hits is cut off by a quarter of step x change of slope.",
      overView("emissivity")};
  return t;
}

const ParameterTable& transmission() {
  static const ParameterTable t{"transmission",
                                "Of the whole layer that a surface stands for (a pane of glass is one surface), at each crossing; over view angle as an "
                                "emission. Reflectance + transmittance + given emissivity must not exceed 1.",
                                overView("transmittance")};
  return t;
}

ParameterTable light(const LightModel& model) {
  ParameterTable t{
      "light: " + model.name,
      model.description,
      {required(text("name", "unique name", &PointLight::name)), text("model", "`" + model.name + "`" + (model.name == "lamp" ? ", or left out" : ""))}};
  t.parameters.insert(t.parameters.end(), model.parameters.begin(), model.parameters.end());
  t.parameters.push_back(withDefault(within(number("radius", "m", "distances to it are bounded below by this", &PointLight::radius_m), 1e-6, 1e6), "0.05 m"));
  t.parameters.push_back(withDefault(boolean("visible", "adds its own flux to the pixel it is seen in", &PointLight::visible), "true"));
  if (model.hasAxes) t.parameters.push_back(any("look_at", "what its x axis points at: name of an entity or of a light before it, or a position [x, y, z]"));
  addPlacement(t.parameters, model.hasAxes);
  addLifetime(t.parameters);
  return t;
}

const ParameterTable& entity() {
  static const ParameterTable t = [] {
    ParameterTable x{"entity",
                     "A body: shape, surface, place.",
                     {required(text("name", "unique name", &Entity::name)), required(map("shape", "what it looks like")),
                      any("material", "of all parts without one of their own: a name, or a material written out"),
                      any("temperature", "of all parts without one of their own: a number, a course (a number over time), a texture, or a map with `recovery`"),
                      map("parts", "part name: material and temperature")}};
    addPlacement(x.parameters, true);
    addLifetime(x.parameters);
    return x;
  }();
  return t;
}

const ParameterTable& part() {
  static const ParameterTable t{
      "part",
      "",
      {any("material", "name of a material, or one written out"), any("temperature", "a number, a course, a texture in K, or a map with `recovery`")}};
  return t;
}

const ParameterTable& shape() {
  static const ParameterTable t{
      "shape",
      "",
      {required(choice("model", {"plate", "box", "disc", "sphere", "ellipsoid", "cylinder", "cone", "terrain", "sea", "ground", "jet", "missile", "mesh"},
                       "kind; body axes x forward, y left, z up; see the table of shapes")),
       within(number("width", "m", "plate, box, ellipsoid: along y"), 1e-6, 1e7),
       within(number("height", "m", "plate, box, ellipsoid: along z"), 1e-6, 1e7),
       within(number("radius", "m", "disc, sphere, cylinder, cone (base)"), 1e-6, 1e7),
       within(number("top_radius", "m", "cone: at its +x end, 0 unless given"), 0, 1e7),
       within(number("length", "m", "cylinder, cone, box, ellipsoid: along x"), 1e-6, 1e7),
       withDefault(integer("segments", "disc, sphere, ellipsoid, cylinder, cone: around", 8, 2048), "64"),
       withDefault(boolean("capped", "cylinder, cone"), "true"),
       withDefault(choice("fit", {"inscribed", "equal_area"}, "sphere: vertices on it, or the same projected area"), "equal_area"),
       within(number("size", "m", "terrain, sea (at most 100 km): side of the square", &TerrainShape::size_m), 1e-3, 1e6),
       within(number("relief", "m", "terrain: height range", &TerrainShape::relief_m), 0, 1e4),
       withDefault(integer("columns", "terrain: cells along a side", 1, 1024, &TerrainShape::columns), "128"),
       withDefault(integer("terrain_seed", "terrain", 0, 1000000000, &TerrainShape::seed), "1"),
       map("height_map", "terrain: a texture of heights instead of noise"),
       within(number("wind", "m/s", "sea: 10 m above it", &SeaPatch::wind_m_s), 0, 40),
       within(number("wind_to", "rad", "sea: where the wind blows to, from x towards y; along x unless given", &SeaPatch::windTo_rad), -2 * kHalfTurn,
              2 * kHalfTurn),
       withDefault(integer("points",
                           "sea: along a side, a power of two; waves from twice their distance on are drawn, shorter ones are the material's "
                           "(`reflection: sea` with `step`: that distance)",
                           4, 2048, &SeaPatch::points),
                   "256"),
       withDefault(integer("sea_seed", "sea", 0, 1000000000, &SeaPatch::seed), "1"),
       within(number("time", "s", "sea: at which its waves stand; 0 s unless given", &SeaPatch::time_s), -1e6, 1e6),
       within(number("extent", "m", "ground: how far it reaches from its position; 400 km unless given, the horizon from 12.5 km up"), 1, 1e6),
       within(number("tile", "m",
                     "ground: length over which u and v grow by 1 (a texture with `edges: repeat` begins anew); unless given they go from 0 to 1 "
                     "over all of it"),
              1e-3, 1e6),
       text("file", "mesh: .obj .stl .ply .vtp .gltf .glb"),
       within(number("unit", "m", "mesh: length of one unit of the file"), 1e-9, 1e9),
       choice("forward", kAxes, "mesh: where its nose points in the axes of its file; +x unless given, of glTF +z"),
       choice("up", kAxes, "mesh: where its upper side points in the axes of its file; +z unless given, of glTF +y (Blender writes OBJ with +y up)"),
       within(number("scale", "", "factor on all lengths"), 1e-9, 1e9)}};
  return t;
}

const ParameterTable& waypoint() {
  static const ParameterTable t = [] {
    ParameterTable x{"waypoint", "", {required(within(number("time", "s", "rising"), -kLongestTime_s, kLongestTime_s))}};
    addPlacement(x.parameters, true, 2 * kHalfTurn);
    std::erase_if(x.parameters, [](const Parameter& p) {
      return p.key == "motion" || p.key == "interpolation" || p.key == "attached_to" || p.key == "ends" || p.key == "spin";
    });
    return x;
  }();
  return t;
}

const ParameterTable& camera() {
  static const ParameterTable t = [] {
    ParameterTable x{
        "camera",
        "A pinhole projection with a real aperture; up to 16 channels.",
        {required(text("name", "unique name; begins the file names", &Camera::name)),
         any("sensor", "a library sensor's name, or {file: ...}: its keys hold where the camera has none of its own"),
         required(map("film", "pixels")),
         within(course("focal_length", "m", "with `pitch` of the film"), 1e-6, 1e4),
         within(
             course("field_of_view", "rad",
                    "horizontal, instead of focal length (then 50 mm) or of pitch; over time it zooms: the focal length goes evenly from row to row, pitch and "
                    "aperture stay"),
             1e-9, 3.1),
         within(number("aperture", "m", "diameter of the entrance pupil; needed unless `f_number` tells it"), 1e-9, 1e3),
         within(number("f_number", "",
                       "focal length over aperture (an ideal, aplanatic lens: the film gets pi L / (4 F^2) on the axis); with either the other "
                       "follows, with both all three must agree"),
                0.5, 1e4),
         spectrum("optics", "", "transmission of the optics, 0..1; 0 outside its table, as a response is"),
         within(course("exposure", "s", "exposure time, around the frame's time"), 1e-12, 1e6),
         withDefault(boolean("motion_blur", "what moves while it exposes is drawn at several times of the exposure", &Camera::motionBlur), "false"),
         integer("exposure_parts", "so many times; unless given as many as the accuracy (1 % where none is asked for) takes", 1, 256, &Camera::exposureParts),
         withDefault(within(number("near", "m", "nearest distance drawn", &Camera::near_m), 1e-4, 1e5), "0.1 m"),
         any("samples",
             "n: n x n subpixels per pixel, 1 to 16; or auto: 2 x 2, shaded one by one only where they see different parts or neighbouring pixels "
             "differ; a shadow or a glint narrower than a pixel within a part may be missed. Without this key: auto where an accuracy is asked for (the "
             "reference: 2), else 1"),
         withDefault(within(number("small_bodies", "",
                                   "bodies spanning fewer pixels are drawn by a zoomed view of their own and keep their intensity at any range (0: draw all as "
                                   "they fall on pixels)",
                                   &Camera::smallBody_px),
                            0, 256),
                     "16"),
         map("spectral", "wavelength sampling"),
         list("channels", "spectral channels", 1, 64),
         boolean("eye", "adds the channels X, Y and Z of the CIE 1931 observer in cd/m2; previews show them as one picture in sRGB"),
         list("stages", "what its optics, detector and electronics do to its pictures, in this order", 0, 32),
         map("spectral_image", "also writes <camera>_<frame>_spectral.exr, which `pitviper integrate` takes"),
         list("truth",
              "extra layers: range, entity, temperature, normal, area, solid_angles, pixel_solid_angle (of each pixel's field, sr), terms (what each channel's "
              "light is made of, worked out in double precision: slow); and targets: place, range, intensity, contrast, signal to noise of each body and lamp, "
              "in "
              "the frame and in <camera>_truth.csv",
              0, 9),
         any("look_at",
             "name of an entity or a light, or a position [x, y, z]; with a `gimbal` its target, and heading, pitch and roll are of the gimbal's base"),
         any("stabilised",
             "angles of its carrier that its mount keeps from it, and from its gimbal's base: one of roll, pitch and yaw or a list of them. Roll and pitch are "
             "level then, yaw is "
             "that of the scenario's start; its own heading, pitch and roll come on top"),
         map("gimbal", "two axes that follow what it looks at, within their limits")}};
    addPlacement(x.parameters, true);
    return x;
  }();
  return t;
}

const ParameterTable& sensorFile() {
  static const ParameterTable t{
      "sensor of a camera", "A sensor in a file of its own.", {required(text("file", "YAML with a key `camera`, relative to the scenario"))}};
  return t;
}

const ParameterTable& cameraPreset() {
  static const ParameterTable t{
      "sensor file",
      "What a camera's `sensor` names; also the form of sensors/library/<name>.yaml of those that are cameras.",
      {text("description", "what it is"), text("source", "where the figures come from"), required(map("camera", "any keys of a camera"))}};
  return t;
}

const ParameterTable& film() {
  static const ParameterTable t{
      "film",
      "",
      {required(integer("width", "pixels", 1, 16384)), required(integer("height", "pixels", 1, 16384)), within(number("pitch", "m", "pixel pitch"), 1e-9, 1),
       within(number("pitch_y", "m", "vertical pitch where different"), 1e-9, 1),
       withDefault(integer("binning",
                           "so many by so many pixels are read as one: width, height and pitch are the detector's own; charges add up before read-out", 1, 16),
                   "1"),
       list("window", "[left, top, width, height] of what is read out [pixels of the picture]; all of the film is drawn", 4, 4)}};
  return t;
}

const ParameterTable& channel() {
  static const ParameterTable t{
      "channel",
      "Response: a spectrum (`band`, table, file, library name) or `product` of several; zero outside its table.",
      {required(text("name", "unique in the camera")), required(spectrum("response", "", "spectral response S(lambda)")),
       spectrum("quantum_efficiency", "", "photoelectrons per photon, for `electrons`"),
       within(course("exposure", "s", "exposure time of this channel, around the frame's time; its camera's unless given"), 1e-12, 1e6),
       list("stages", "of this channel alone: each in place of its camera's stage of that name, or besides them; `distortion` is the camera's", 0, 32),
       any("gain", "for `volts`: in V/W of pixel flux or V/(W/m2) of focal-plane irradiance"),
       any("output", "a quantity or a list of quantities (default radiance), see below")}};
  return t;
}

const ParameterTable& spectral() {
  static const ParameterTable t{
      "spectral",
      "Sampling of each channel over wavelength, from band edge to band edge exactly.",
      {withDefault(integer("samples", "wavelengths per channel", 1, 512, &SpectralSampling::samples), "16"),
       withDefault(choice("spacing", {{"gauss", Spacing::Gauss}, {"even", Spacing::Even}, {"log", Spacing::Log}},
                          "gauss: Gauss points of the response, error below 0.1 % with 16 for spectra smooth over the band; even, log: equal cells",
                          &SpectralSampling::spacing),
                   "gauss"),
       withDefault(
           boolean("shared", "one set of wavelengths for all channels, over the union of their bands (split at every band edge)", &SpectralSampling::shared),
           "false")}};
  return t;
}

const ParameterTable& spectralImage() {
  static const ParameterTable t{
      "spectral_image",
      "Mean spectral radiance at the aperture in bins of wavelength, a layer each. Rendering time grows with bins x samples.",
      {required(list("band", "[from, to]: first and last edge, such as [3 um, 5 um]", 2, 2)), withDefault(integer("bins", "layers", 2, 512), "32"),
       withDefault(choice("spacing", {"even", "log"}, "even: bins of equal width; log: of equal ratio"), "even"),
       withDefault(integer("samples", "Gauss points per bin (of log bins: of the narrowest drawn together)", 2, 16, &SpectralBins::samples), "4")}};
  return t;
}

const ParameterTable& sensor() {
  static const ParameterTable t{
      "sensor (file of `pitviper integrate`)",
      "What looks at a spectral image. What is not given is as of the camera that drew it; the pixels' fields of view stay as they are, so `focal_length` and "
      "`pixel_pitch` change together.",
      {text("name", "written into the frame (default: the file's name)"), text("description", "one or two sentences"),
       within(number("focal_length", "m", "the pixel pitch follows"), 1e-6, 1e4),
       within(number("pixel_pitch", "m", "horizontal; the focal length follows"), 1e-9, 1),
       within(number("aperture", "m", "diameter of the entrance pupil"), 1e-9, 1e3),
       spectrum("optics", "", "transmission of the optics, 0..1, and 0 outside its table (1 unless given, whatever the camera's was)"),
       within(number("exposure", "s", "exposure time"), 1e-12, 1e6), required(list("channels", "as a camera's", 1, 64))}};
  return t;
}

const ParameterTable& probe() {
  static const ParameterTable t{
      "probe",
      "Irradiance on a plane at a point, whole hemisphere.",
      {required(text("name", "unique name", &Probe::name)),
       required(within(vector3("position", "m", "east, north, up", &Probe::position), -kFarthest_m, kFarthest_m)),
       withDefault(within(vector3("normal", "", "direction the plane faces", &Probe::normal), -1e6, 1e6), "0, 0, 1"),
       withDefault(integer("resolution", "rays across a quarter turn", 16, 2048, &Probe::resolution), "512"), map("spectral", "wavelength sampling"),
       required(list("channels", "as a camera's; output irradiance, photon_irradiance or illuminance", 1, 16))}};
  return t;
}

std::vector<ParameterTable> all() {
  std::vector<ParameterTable> every{scenario(), entryOfList(), repeat(), render(), origin(), refraction(), time(), limits(), accuracy(), commonAirTable()};
  const auto addAll = [&every](const auto& registry, const auto& tableOf) {
    for (const auto& model : registry.all()) every.push_back(tableOf(model));
  };
  addAll(airModels(), airTable);
  every.push_back(cloudTable());
  for (const auto& t : {airLibrary(), background(), ground(), sun(), ambient(), gradientEntry(), environmentMap(), environmentLayer(), spectrumTable(),
                        material(), temperatureState()})
    every.push_back(t);
  addAll(reflectionModels(), componentTable);
  addAll(mediumModels(), medium);
  for (const auto& t : {filmLayerTable(), refractiveIndexTable(), angleAxisTable(), texture(), emission(), transmission()}) every.push_back(t);
  addAll(lightModels(), light);
  for (const auto& t : {courseTable(),     entity(),       part(),       recovery(),  shape(),           waypoint(),      ends(),   spin(),
                        motionWaypoints(), motionRoute(),  routePoint(), motionCsv(), motionBallistic(), motionMissile(), wind(),   geodetic(),
                        camera(),          cameraPreset(), film(),       channel(),   spectral(),        spectralImage(), sensor(), probe()})
    every.push_back(t);
  for (const auto& t : gimbalTables()) every.push_back(t);
  for (const auto& t : {plume(), plumeNozzle(), plumeSpecies(), plumeGrid(), plumeArrays(), smoke(), flare(), flareDirection(), flareSequence(), cumulus(),
                        cumulusFieldTable()})
    every.push_back(t);
  addAll(stageModels(), stageTable);
  addAll(commandModels(), commandTable);
  addAll(sinkModels(), sinkTable);
  return every;
}

}  // namespace pitviper::tables
