#include "sim/scene/import/vti_reader.hpp"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkLogger.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataReader.h>

#include "sim/scene/import/complaints.hpp"
#include "sim/scene/import/import_failure.hpp"
#include "sim/scene/import/memory_file.hpp"

namespace pitviper {
namespace {

std::string namesOf(vtkDataSetAttributes* data) {
  std::string names;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (const char* name = data->GetArrayName(i)) names += (names.empty() ? "'" : ", '") + std::string(name).substr(0, 60) + "'";
  return names;
}

}  // namespace

GridData readVti(const GridRequest& request) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<Complaints> complaints;
  vtkOutputWindow::SetInstance(complaints);
  const MemoryFile copy(request.bytes);
  const std::string name = copy.name();
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(name.c_str());
  reader->UpdateInformation();
  const auto complain = [&] {
    if (!complaints->first.empty()) throw ImportFailure{placeIn(request.file, complaints->first), "the reader says: " + complaints->first, "a sound file", ""};
  };
  complain();
  const int* extent = reader->GetUpdateExtent();
  double count = 1.0;
  for (int axis = 0; axis < 3; ++axis) count *= static_cast<double>(extent[2 * axis + 1]) - static_cast<double>(extent[2 * axis]) + 1.0;
  if (count > static_cast<double>(kMostGridNodes))
    throw ImportFailure{{request.file},
                        "a grid of " + std::to_string(static_cast<long long>(count)) + " nodes",
                        "at most " + std::to_string(kMostGridNodes),
                        "cut or thin it out"};
  reader->Update();
  complain();
  vtkImageData* image = reader->GetOutput();
  if (image == nullptr || image->GetNumberOfPoints() < 1) throw ImportFailure{{request.file}, "the file has no grid", "one piece of image data", ""};
  if (!image->GetDirectionMatrix()->IsIdentity())
    throw ImportFailure{{request.file}, "the grid is turned by a Direction", "a grid along x, y and z", "resample it, or turn it by 'forward' and 'up'"};

  vtkDataSetAttributes* data = image->GetPointData();
  const auto holdsAll = [&](vtkDataSetAttributes* in) {
    for (const std::string& wanted : request.names)
      if (in->GetArray(wanted.c_str()) == nullptr) return false;
    return true;
  };
  const bool ofCells = !holdsAll(data) && holdsAll(image->GetCellData());
  if (ofCells) data = image->GetCellData();
  GridData grid;
  int nodes[3];
  image->GetDimensions(nodes);
  double origin[3], spacing[3];
  image->GetOrigin(origin);
  image->GetSpacing(spacing);
  int first[6];
  image->GetExtent(first);
  for (int axis = 0; axis < 3; ++axis) {
    grid.nodes[axis] = nodes[axis] - (ofCells ? 1 : 0);
    grid.spacing[axis] = spacing[axis];
    grid.origin[axis] = origin[axis] + (first[2 * axis] + (ofCells ? 0.5 : 0.0)) * spacing[axis];
  }
  for (const std::string& wanted : request.names) {
    vtkDataArray* array = data->GetArray(wanted.c_str());
    if (array == nullptr) {
      const std::string points = namesOf(image->GetPointData()), cells = namesOf(image->GetCellData());
      throw ImportFailure{{request.file},
                          "there is no array '" + wanted.substr(0, 60) + "' with the others",
                          "one of its points' arrays (" + (points.empty() ? "none" : points) + ") or of its cells' (" + (cells.empty() ? "none" : cells) + ")",
                          "correct the name under 'arrays', or write all of points or all of cells"};
    }
    if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != static_cast<vtkIdType>(grid.count()))
      throw ImportFailure{{request.file},
                          "array '" + wanted.substr(0, 60) + "' has " + std::to_string(array->GetNumberOfTuples()) + " x " +
                              std::to_string(array->GetNumberOfComponents()) + " values",
                          std::to_string(grid.count()) + " of one component",
                          ""};
    grid.arrays.push_back({wanted, std::vector<float>(grid.count())});
    for (std::size_t i = 0; i < grid.count(); ++i) grid.arrays.back().values[i] = static_cast<float>(array->GetTuple1(static_cast<vtkIdType>(i)));
  }
  return grid;
}

}  // namespace pitviper
