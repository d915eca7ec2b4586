#pragma once
// What a pixel is made of: a number for each part and channel, and its spectrum, worked out by the reference.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/camera/camera_renderer.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Values of a pixel per output of its camera, before a detector, temperatures and the sensor's stages.
struct PixelParts {
  struct Column {
    std::string layer;                                   ///< of a frame: "mw.radiance"
    std::string unit;                                    ///< "electron" of what is detected
    double perIntegral = 1.0;                            ///< factor of the integral of kernel x radiance [kernel unit x W/(m2 sr)]
    std::shared_ptr<const BandTemperature> temperature;  ///< of the kernel
  };
  struct Row {
    std::string name;
    Part part;
    std::vector<double> values;  ///< per column
  };
  std::vector<Column> columns;  ///< in the order of Camera::outputs
  std::vector<double> all;      ///< per column: the pixel drawn as a whole
  std::vector<Row> rows;        ///< that are not zero throughout
  /// all - sum of rows: the sun's disc and stars where they are in view; else rounding of pictures, 1e-7 of `all` a row, where small bodies are 2e-5.
  std::vector<double> rest;
};

/// Mean radiance of a pixel over bins of wavelength. Each bin has wavelengths of its own (fineGrid()): with a channel's response its integral is the channel's
/// value within 1e-3 in clear air, and within 1e-2 where gas shines through the steep edges of its own lines.
struct PixelSpectrum {
  struct Curve {
    std::string name;
    Part part;                   ///< of no body: all that send light of this kind, or light of this lamp, together
    std::vector<double> values;  ///< [W/(m2 sr um)] per bin
  };
  std::vector<double> edge_um, wavelength_um;  ///< of bins, one more than these; their middles
  std::vector<double> all;                     ///< [W/(m2 sr um)] per bin: the pixel drawn as a whole
  std::vector<Curve> parts;                    ///< that are not zero throughout
  std::vector<double> rest;                    ///< as of PixelParts
};

/// Temperature of a black body of which the column has as much; none where no body of 20 to 20000 K has.
std::optional<double> apparentTemperature_K(const PixelParts::Column& column, double value);

/// Pixels of one camera, which is drawn by the reference whatever mode it asks for. A picture of its scene is drawn for each part of a pixel.
class PixelPartsMeter {
 public:
  /// The simulation and the library must outlive it. Needs a current GlContext, as all its functions do.
  PixelPartsMeter(const Simulation& simulation, const Camera& camera, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  /// Column and row of the film from its top left corner. Throws UserError where they are not on it.
  PixelParts at(const WorldState& state, int column, int row);
  /// In even bins. A picture for each part and 16 bins. Throws UserError where the range is none or has no data of the scene, and for a pixel not on the film.
  PixelSpectrum spectrum(const WorldState& state, int column, int row, double low_um, double high_um, int bins);

 private:
  /// Bins that are drawn together.
  struct Pass {
    Camera camera;
    CameraRenderer renderer;
    Pass(const Simulation& simulation, Camera of, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  };
  std::size_t indexOf(int column, int row) const;
  void makePasses(double low_um, double high_um, int bins);
  std::string nameOf(const Part& part) const;
  const Simulation& simulation_;
  const ShaderLibrary& library_;
  std::shared_ptr<const GpuScene> scene_;
  Camera camera_;
  CameraRenderer renderer_;
  std::vector<std::shared_ptr<const BandTemperature>> temperatures_;  ///< per output
  SpectralBins bins_;                                                 ///< of the passes
  std::vector<std::unique_ptr<Pass>> passes_;                         ///< of the spectrum asked for last
};

}  // namespace pitviper
