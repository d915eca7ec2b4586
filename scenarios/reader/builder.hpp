#pragma once
// What the parts of the scenario reader share: the simulation being built, names seen so far, libraries.
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "materials/media.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/reader/sensor_reader.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/spectrum_value.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

enum class Species;

/// More subpixels than a picture may have.
bool tooLarge(const Camera& camera);
/// Is there a stage among these that makes counts? (Their order and keys are read later.)
bool makesCounts(const Value& stages);

/// What a file held, as 64 hexadecimal digits.
std::string sha256(const std::string& text);

struct Collector;

class Builder {
 public:
  Builder(Simulation& simulation, std::filesystem::path base, Libraries libraries);

  void readOrigin(const Record& scenario);
  void readTime(const Record& scenario);
  void readLimits(const Record& scenario);
  void readAirMotion(const Record& scenario);
  /// After everything that can be narrow in wavelength: air and materials.
  void readAccuracy(const Record& scenario);
  void readAtmosphere(const Record& scenario);
  /// After origin and air, before everything that has a place.
  void readRefraction(const Record& scenario);
  void readBackground(const Record& scenario);
  void readSun(const Record& scenario);
  void readStars(const Record& scenario);
  void readMaterials(const Record& scenario);
  /// After materials and air.
  void readGround(const Record& scenario);
  /// After the ground.
  void readAmbient(const Record& scenario);
  void readEntities(const Record& scenario);
  void readLights(const Record& scenario);
  /// After entities and the air; flares add lights.
  void readPlumes(const Record& scenario);
  void readSmokes(const Record& scenario);
  void readFlares(const Record& scenario);
  void readCumuli(const Record& scenario);
  void readCameras(const Record& scenario);
  void readProbes(const Record& scenario);
  /// After everything that they can change.
  void readCommands(const Record& scenario);
  void readSinks(const Record& scenario);
  /// `image`: the camera that drew the spectral image.
  void readSensor(const Record& file, const Pinhole& image, double exposure_s, Sensor& sensor);

 private:
  // materials.cpp
  int materialNamed(const Value& asked);
  std::shared_ptr<const Material> readMaterial(const Value& value, const std::string& name, const SpectrumReader& spectra);
  std::shared_ptr<const Material> readMaterialFile(const Value& value, const std::string& name);
  /// `what`: "emissivity" or "transmittance".
  ViewSpectrum readViewSpectrum(const Record& r, const char* what, const std::string& material, const SpectrumReader& spectra);
  Medium readMedium(const MediumModel& model, const Record& r, const std::string& material, const SpectrumReader& spectra) const;
  /// Adds it to a material, and to each of its entries where a texture drives its state or that of one before.
  /// A surface's components at rising temperatures.
  void readTemperatureStates(const Value& list, const SpectrumReader& spectra, Material& material);
  void checkTemperatures(int material, double low_K, double high_K, const Location& where) const;
  void readComponent(const Value& value, const SpectrumReader& spectra, Material& material, std::vector<std::shared_ptr<const Material>>& entries);
  /// A file of materials/substances as a tree.
  Value substanceNamed(const std::string& name, const Location& asked) const;
  int readTexture(const Value& value, std::string_view unit, std::string_view name, double lowest, double highest);
  // moving.cpp
  struct Placement {
    Motion motion;
    int carrier = -1;
    Lifetime lifetime;
    std::shared_ptr<const FlightRecord> flight;
    bool fliesLater = false;  ///< its motion depends on others: flyAll() works it out
  };
  enum class Mover { Entity, Light, Beam, Camera };  ///< a beam is a light that has axes
  Placement readPlacement(const Record& r, Mover mover);
  /// What a camera or a light (`what`) looks at, after its placement. Errors: UserError where nothing says where it points.
  void readLookAt(const Record& r, const std::string& what, Mount& mount) const;
  /// A flight of something whose carrier and target have their motions; it is then its own.
  void flyNow(const Record& r, Mover mover, Placement& placement);
  /// Motions of the entities that fly, targets and carriers first. Errors: UserError for those that wait for each other.
  void flyAll();
  /// After flyAll(): temperatures that follow from motions.
  void readRecoveries();
  /// A temperature that is not a texture: a number, a course, or one that readRecoveries() works out.
  void readTemperature(const Value& value, int entity, int surface, Surface& s);
  int targetNamed(const Value& asked) const;
  // bodies.cpp
  std::shared_ptr<const Mesh> shapeOf(const Value& value, BodyForm& form);
  std::shared_ptr<const Mesh> readShape(const Value& value, BodyForm& form);
  void checkMedium(const Record& entity, const Entity& e) const;
  void readSurfaces(const Record& r, Entity& entity);
  int entityNamed(const Value& asked) const;
  // cameras.cpp
  /// `camera`: whose they are, which gets what they have of their own; null: none, and they may have nothing of their own.
  std::vector<ChannelOutput> readChannels(const Value& list, const Spectrum* optics, const Pinhole* pinhole, double exposure_s, bool hasDetector = false,
                                          Camera* camera = nullptr);
  /// What a channel has of its own: its exposure, and what it says of its detector goes into `collector`.
  void readOwn(const Record& channel, Camera* camera, Collector& collector) const;
  // camera_stages.cpp
  /// Of all its channels, which are read.
  void readStages(const Record& r, Camera& camera) const;
  /// Its kernel is as it will be.
  static void tellTemperature(ChannelOutput& output);
  Spectrum readResponse(const Record& channel) const;
  void keepOutput(std::vector<ChannelOutput>& outputs, const std::function<ChannelOutput()>& make, const Location& where) const;
  void planned(const std::vector<ChannelOutput>& outputs, const SpectralSampling& sampling, const Location& where);
  SpectralSampling readSpectral(const Record& r);
  // plumes.cpp
  /// With the levels that it needs between two temperatures.
  FieldGas gasOf(Species species, double low_K, double high_K);
  void readJets(const Record& r, FieldBody& body);
  void readGrid(const Record& r, FieldBody& body);
  /// Begin and end within the times at which an entity is there.
  void whileThere(int entity, double& begin_s, double& end_s, const Record& r, const char* key, const char* shouldDo) const;
  // smokes.cpp
  /// A material of a field's gas, made once by each name.
  int fieldMaterial(const std::string& name, const std::string& source, const std::function<Medium()>& make);
  /// Of a smoke by name; `where`: who asks.
  int smokeMaterial(const std::string& name, const Location& where);
  /// How much warmer the air is than the standard atmosphere's.
  double airWarmer_K() const;
  // cumuli.cpp
  /// Of the air at a place, else of the standard atmosphere.
  double airAt_K(const glm::dvec3& place) const;
  // sensor_reader.cpp
  SpectralBins readSpectralBins(const Record& r, const Pinhole& pinhole);

  void checkUnique(const Value& name, std::map<std::string, Location>& names, const char* what);
  /// A spectrum whose values are finite and lie in [low, high] wherever it has data.
  static Spectrum bounded(const SpectrumReader& spectra, const Value& value, std::string_view unit, std::string_view name, double low, double high,
                          Outside outside = Outside::Error);
  Spectrum blackOrGiven(const Record& r, const char* what) const;
  // ambient.cpp
  std::shared_ptr<const MixedSurroundings> gradientOf(const Record& ambient) const;
  std::shared_ptr<const MixedSurroundings> mapOf(const Record& ambient) const;

  SpectralSampling accuracy_;  ///< of cameras without a sampling of their own
  Simulation& simulation_;
  std::filesystem::path base_;  ///< folder of the scenario
  Libraries libraries_;
  SpectrumReader spectra_;
  std::size_t planSteps_ = 0;
  std::map<std::string, ParameterTable> componentTables_;  ///< by model
  std::map<std::string, double> componentShares_;          ///< of all that a scenario may hold of a model
  std::map<std::string, int> materialIndex_;
  std::map<std::string, const Value*> materialValues_;
  std::map<std::string, Location> entityNames_, lightNames_, cameraNames_;
  std::map<std::string, int> entityIndex_;
  std::map<std::string, int> fieldMaterials_;
  std::map<std::array<double, 3>, FieldGas> gases_;  ///< by species and temperatures
  std::map<std::string, Location> smokeNames_;
  bool hasOrigin_ = false;
  std::map<int, const Value*> fliesLater_;  ///< entities, as they were written
  double stepsFlown_ = 0.0;                 ///< of all flights so far
  struct Recovery {
    int entity, surface;
    const Value* value;
  };
  std::vector<Recovery> recoveries_;
  std::map<std::string, std::pair<std::shared_ptr<const Mesh>, BodyForm>> shapes_;
  std::function<double(double)> bending_;  ///< by how much air lifts what stands at a true elevation [rad]; none: not at all
};

}  // namespace pitviper
