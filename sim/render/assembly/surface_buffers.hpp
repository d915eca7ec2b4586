#pragma once
// The tables of one kind of surfaces on the GPU.
#include "sim/gl/objects.hpp"
#include "sim/render/assembly/tables.hpp"

namespace pitviper {

class SurfaceBuffers {
 public:
  explicit SurfaceBuffers(const SurfaceTables& tables) : general_(tables.general) {
    update(tables);
    hemispherical_.upload(tables.hemispherical);
    columns_.upload(tables.columns);
    transmittance_.upload(tables.transmittance);
    materials_.upload(tables.packedMaterials());
  }
  /// What follows temperatures.
  void update(const SurfaceTables& tables) { rows_.upload(tables.rows); }
  void bind() const {
    rows_.bindTexture(1, 4);
    if (general_) {
      hemispherical_.bindTexture(2, 4);
      columns_.bindTexture(3, 4);
    }
    transmittance_.bindTexture(4, 1);
    materials_.bindTexture(10, 4, true);
  }

 private:
  bool general_;
  Buffer rows_, hemispherical_, columns_, transmittance_, materials_;
};

}  // namespace pitviper
