#pragma once
// A whole scenario, typed and in SI, as the kernel sees it: nothing here knows where it was read from.
#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/atmosphere.hpp"
#include "sim/model/channel.hpp"
#include "sim/model/command.hpp"
#include "sim/model/field.hpp"
#include "sim/model/follower.hpp"
#include "sim/model/material.hpp"
#include "sim/model/sink.hpp"
#include "sim/model/stage.hpp"
#include "sim/model/store.hpp"
#include "sim/model/sun_shade.hpp"
#include "sim/model/surroundings.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectral_rule.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// How a camera's channels are sampled over wavelength.
struct SpectralSampling {
  int samples = 16;
  Spacing spacing = Spacing::Gauss;
  bool shared = false;     ///< one set of nodes for all channels, over the union of their bands
  double accuracy = 0.0;   ///< relative error that the plan may spend: it chooses wavelengths, terms and tables; 0: as the above says
  bool reference = false;  ///< every wavelength of the fine grid, in double precision on the CPU
  double atMost = 0.0;     ///< the error that a stream may fall back to where it cannot hold its rate; 0: none but `accuracy`
};

/// Neighbouring bins of wavelength, each averaged with Gauss points.
struct SpectralBins {
  std::vector<double> edge_um;  ///< one more than bins, rising
  int samples = 4;              ///< wavelengths per bin
  Location where;
  int count() const { return static_cast<int>(edge_um.size()) - 1; }
};

/// Extra layers a camera can be asked for.
struct TruthLayers {
  bool range = false, entity = false, normal = false, temperature = false, area = false, solidAngles = false;
  bool pixelSolidAngle = false;  ///< of the camera alone: nothing is drawn for it
  bool terms = false;            ///< what each channel's light is made of, in double precision (sim/frame/truth_terms.hpp)
  bool targets = false;          ///< a row for each body and lamp (sim/frame/truth_table.hpp)
  /// What has to be drawn.
  bool any() const { return range || entity || normal || temperature || area || solidAngles; }
};

/// A subpixel of a frame: its place on the film [pixels from the top left].
struct FilmPlace {
  int frame = 0;
  double column = 0.0, row = 0.0;
  std::optional<Pose> pose = {};  ///< of a camera that something points, at that time
};

/// What a channel has of its own, in place of its camera's.
struct OwnChannel {
  std::optional<double> exposure_s;
  TimeCourse exposureOverTime_s;    ///< empty: as above; else above is what holds at the first frame
  std::vector<StageChoice> stages;  ///< all of it
  bool hasDetector = false;         ///< one that its camera's other channels do not share
};

struct Camera {
  std::string name;
  Location where;
  Pinhole pinhole;
  Mount mount;
  double exposure_s = 0.0;
  TimeCourse focalLengthOverTime_m, exposureOverTime_s;  ///< empty: as above; else above is what holds at the first frame
  double near_m = 0.1;
  int samples = 1;                   ///< n: n x n subpixels
  bool motionBlur = false;           ///< what moves while it exposes is drawn at several times of it
  int exposureParts = 0;             ///< so many; 0: by the accuracy (sim/camera/exposure_parts.hpp)
  bool pointsApart = false;          ///< what is smaller than a subpixel is not drawn but told as points: stages take them
  int binning = 1;                   ///< so many by so many of the detector's own pixels are read as one of `pinhole`
  std::optional<glm::ivec4> window;  ///< of the film that is read out: left, top, width, height [pixels]
  bool sharesShading = false;        ///< those of a pixel are shaded as one where neighbouring pixels are alike
  double smallBody_px = 16.0;        ///< bodies smaller than this are drawn by their own zoomed view
  int zoomedSamples = 256;           ///< at most so many across it, unless it has more subpixels; a medium, which fades towards its silhouette, half as many
  double outlineAccuracy = 0.0;      ///< to which the areas of small bodies are asked for, by fewer; 0: zoomedSamples
  double textureAccuracy = 0.0;      ///< as Plan::textureAccuracy; the same for the reference that the camera is held against
  SpectralSampling spectral;
  std::vector<FilmPlace> learnt;  ///< lines of sight that its plan must hold for besides those it draws: where an audit found more than was asked
  std::string plan;               ///< text of a plan to draw with, as written by another run; empty: one is made
  std::string planFile;           ///< where it came from, for messages
  std::vector<ChannelOutput> outputs;
  std::vector<StageChoice> stages;                ///< of its sensor, after the spectral integral
  std::map<std::string, OwnChannel> ownChannels;  ///< by name, of those that have an exposure or stages of their own
  std::optional<SpectralBins> spectralImage;      ///< written beside the frame
  TruthLayers truth;
  std::optional<FollowerChoice> follower;  ///< what points it, besides its mount; none: its mount

  const OwnChannel* ownChannel(const std::string& channel) const {
    const auto found = ownChannels.find(channel);
    return found == ownChannels.end() ? nullptr : &found->second;
  }
  const std::vector<StageChoice>& stagesOf(const std::string& channel) const {
    const OwnChannel* own = ownChannel(channel);
    return own ? own->stages : stages;
  }
  bool hasStages() const {
    return !stages.empty() || std::any_of(ownChannels.begin(), ownChannels.end(), [](const auto& own) { return !own.second.stages.empty(); });
  }
  /// At the first frame.
  double exposureOf(const std::string& channel) const {
    const OwnChannel* own = ownChannel(channel);
    return own && own->exposure_s ? *own->exposure_s : exposure_s;
  }
};

/// Irradiance on a plane at a point: layers as a camera's outputs with kernels for irradiance.
struct Probe {
  std::string name;
  Location where;
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0, 0.0, 1.0};
  int resolution = 128;
  SpectralSampling spectral;
  std::vector<ChannelOutput> outputs;
};

struct TimeAxis {
  double start_s = 0.0;
  double step_s = 1.0;
  int frames = 1;
  std::optional<double> epoch_s = {};  ///< UTC of time 0, seconds since 1970 without leap seconds; none: nothing said
  double at(int frame) const { return start_s + step_s * frame; }
};

/// What a plan must hold for besides the scenario's own times, where poses or levels come from elsewhere. 0: nothing said.
struct Limits {
  double nearest_m = 0.0, farthest_m = 0.0;  ///< between a camera and a body
  double coldest_K = 0.0, hottest_K = 0.0;   ///< of a body
  double lightLevel = 0.0;                   ///< greatest, of a point light
  bool any() const { return farthest_m > 0.0 || hottest_K > 0.0 || lightLevel > 0.0; }
};

/// Direct: shading integrates into the channels. Buffered: it leaves a spectral image, over which transparent things are blended and
/// which a further pass integrates. Auto: buffered where something transparent is in view.
enum class RenderMode { Auto, Direct, Buffered };

/// A point of light in the sky.
struct SkyStar {
  std::string name;
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit, local frame, towards it
  Spectrum irradiance;                  ///< above the air, on a plane that faces it [W/(m2 um)]
};

struct Simulation {
  std::string name;
  std::string file;
  std::string sha256;   ///< of its text, of what it extends, and of what was set from outside
  std::string content;  ///< of all that it was made of, tables and meshes whole
  long long seed = 0;
  RenderMode mode = RenderMode::Auto;
  bool shadows = true;  ///< opaque bodies cast them
  bool alone = false;   ///< only one frame of it is wanted
  double audit = -1.0;  ///< pixels a frame that are worked out by the reference; below 0: as many as cost a twentieth of the time
  LocalFrame frame;
  TimeAxis time;
  Limits limits;
  glm::dvec3 wind_m_s{0.0};  ///< where the air goes, local frame
  std::vector<Texture> textures;
  std::vector<std::shared_ptr<const Material>> materials;
  std::vector<Entity> entities;
  std::vector<PointLight> lights;
  std::vector<FieldBody> fields;  ///< jets, smoke, clouds
  std::optional<Sun> sun;
  std::vector<SkyStar> stars;                ///< in view of cameras; they light nothing
  std::shared_ptr<const SunShade> sunShade;          ///< by clouds of drops; null: none
  std::optional<Spectrum> ambient;                   ///< radiance of a uniform dome, or the surroundings' mean [W/(m2 sr um)]
  std::shared_ptr<const Surroundings> surroundings;  ///< of ambient light by direction; null: a uniform dome's
  Spectrum background;                               ///< radiance behind everything [W/(m2 sr um)]
  std::optional<Surface> ground;                     ///< of the earth's sphere, where lines of sight end that meet no body and go down
  std::shared_ptr<const Atmosphere> air;
  std::vector<Camera> cameras;
  std::vector<Probe> probes;
  std::vector<Command> commands;  ///< in the order of their times
  std::vector<Store> stores;      ///< what commands may eject
  std::vector<SinkChoice> sinks;  ///< of its frames; none: files of all of them

  /// More than one picture of a camera: what comes into view later is compiled with the first.
  bool drawsMore() const { return time.frames > 1 && !alone; }
  const Material& materialOf(const Surface& s) const { return *materials[static_cast<size_t>(s.material)]; }
  const Medium* mediumOf(const Entity& e) const {  ///< what fills it, or null
    return e.surfaces.empty() || !materialOf(e.surfaces.front()).medium ? nullptr : &*materialOf(e.surfaces.front()).medium;
  }
  /// The earth, a sphere, is there and hides the sun: under air with a top, or where it has a ground.
  bool overEarth() const { return ground || (air && air->top_m() < physics::kFar); }
  bool isTransparent(const Entity& e) const {  ///< any of its surfaces
    return std::any_of(e.surfaces.begin(), e.surfaces.end(), [this](const Surface& s) { return materialOf(s).isTransparent(); });
  }
  bool hasTransparent() const {
    return !fields.empty() || std::any_of(entities.begin(), entities.end(), [this](const Entity& e) { return isTransparent(e); });
  }
};

}  // namespace pitviper
