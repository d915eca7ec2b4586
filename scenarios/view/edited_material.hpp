#pragma once
// A material under a hand: its curves are dragged, energy holds, every step can be taken back.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/view/curve_ceiling.hpp"
#include "scenarios/view/edited_surface.hpp"

namespace pitviper {

/// Diffuse + specular (+ emissivity where it is given) stay at or below 1 at every wavelength, film or not: of a change that would break it, as much is done as
/// the rest of the curves leaves, and the curve that is changed is the one that yields. What cannot be changed (a point that there is not, a curve that is not
/// given) is left as it is.
class EditedMaterial {
 public:
  EditedMaterial(EditedSurface surface, Libraries libraries);
  /// A material of the library, a file of one, or a file of others (scenarios/import), as surfaceNamed() gives it.
  static EditedMaterial named(const std::string& word, const Libraries& libraries);

  const EditedSurface& surface() const { return now_; }
  const std::string& name() const { return now_.name; }
  const std::vector<std::string>& notes() const { return now_.notes; }
  bool has(CurveKind kind) const { return now_.curve(kind) != nullptr; }
  /// It must have it.
  const EditedCurve& curve(CurveKind kind) const { return *now_.curve(kind); }
  const std::optional<EditedFilm>& film() const { return now_.film; }

  void setName(const std::string& name);
  /// As EditedCurve's; where a new point lies too high, it goes down.
  std::size_t addPoint(CurveKind kind, double wavelength_um, double value);
  void removePoint(CurveKind kind, std::size_t i);
  /// The value goes down to what is left; where no value will do, the point goes a part of the way.
  void movePoint(CurveKind kind, std::size_t i, double wavelength_um, double value);
  void setSmooth(CurveKind kind, bool smooth);
  /// A whole curve, within the kind's bounds.
  void setCurve(CurveKind kind, const EditedCurve& curve);
  /// Given emissivity begins as Kirchhoff's at normal view.
  void giveEmissivity(bool given);
  /// UserError for a film that cannot be; nothing has changed then.
  void setFilm(const std::optional<EditedFilm>& film);

  /// What comes between is one step of undo(); pairs may stand within pairs.
  void beginChange();
  void endChange();
  bool canUndo() const { return !done_.empty() || (open_ > 0 && !(before_ == now_)); }
  bool canRedo() const { return !undone_.empty(); }
  void undo();
  void redo();
  /// Another whenever anything has changed.
  unsigned long long revision() const { return revision_; }

  /// Greatest directional-hemispherical reflectance over view angles, of all components of material(); not a number where it has no data.
  double energyAt(double wavelength_um) const;
  /// A material file that loads anywhere.
  std::string yaml(const std::string& description, const std::string& source) const { return materialText(now_, description, source); }
  std::string yaml() const { return yaml(now_.description, now_.source); }
  /// What that text means (madeMaterial); the same until something changes.
  std::shared_ptr<const Material> material() const;

 private:
  CurveCeiling ceilingOf(CurveKind kind) const;
  void put(CurveKind kind, EditedCurve curve);
  /// Of each change: `next` becomes what it is now.
  void become(EditedSurface next);

  Libraries libraries_;
  EditedSurface now_, before_;  ///< before_: where the change that is open began
  int open_ = 0;
  std::vector<EditedSurface> done_, undone_;
  unsigned long long revision_ = 0;
  mutable std::shared_ptr<const Material> made_;  ///< null: none yet
  mutable unsigned long long madeAt_ = 0;         ///< the revision that it is of
};

}  // namespace pitviper
