#include "sim/scene/import/vtk_readers.hpp"

#include <dlfcn.h>
#include <vtkCellArray.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataObjectTreeIterator.h>
#include <vtkGLTFReader.h>
#include <vtkInformation.h>
#include <vtkLogger.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <vtkXMLPolyDataReader.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "sim/scene/import/complaints.hpp"
#include "sim/scene/import/import_failure.hpp"
#include "sim/scene/import/memory_file.hpp"
#include "sim/scene/import/mesh_builder.hpp"

namespace pitviper {
namespace {

template <class Reader>
void readOne(const std::string& name, const CheckedFile& checked, MeshBuilder& builder) {
  vtkNew<Reader> reader;
  reader->SetFileName(name.c_str());
  reader->Update();
  builder.add(reader->GetOutput(), checked, "");
}

/// The link beside this module that leads to the file of that number (sim/scene/import/CMakeLists.txt).
constexpr const char* kGltfLink = "pitviper_mesh_import.gltf";
constexpr int kGltfNumber = 200;

void readGltf(const MemoryFile& copy, const CheckedFile& checked, MeshBuilder& builder) {
  Dl_info here = {};
  dladdr(reinterpret_cast<const void*>(&kGltfLink), &here);
  const std::filesystem::path link = std::filesystem::path(here.dli_fname != nullptr ? here.dli_fname : "").parent_path() / kGltfLink;
  std::error_code missing;
  if (!copy.alsoAs(kGltfNumber) || !std::filesystem::exists(link, missing))
    throw ImportFailure{{}, "the link " + link.string() + " to the file being read is missing", "a whole build folder", "build pitviper again"};
  vtkNew<vtkGLTFReader> reader;
  reader->SetFileName(link.c_str());
  reader->SetApplyDeformationsToGeometry(true);  // node transforms and morph targets
  reader->Update();
  auto* tree = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  if (tree == nullptr) return;
  vtkNew<vtkDataObjectTreeIterator> at;
  at->SetDataSet(tree);
  at->VisitOnlyLeavesOff();
  at->TraverseSubTreeOn();
  std::string node;
  glm::dmat4 placement(1.0);
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem()) {
    // The reader calls blocks "Node_7" by the number in the file, below them "Mesh_0", and leaves the primitives
    // unnamed.
    vtkInformation* about = at->HasCurrentMetaData() ? at->GetCurrentMetaData() : nullptr;
    const std::string_view block = about != nullptr && about->Has(vtkCompositeDataSet::NAME()) ? about->Get(vtkCompositeDataSet::NAME()) : "";
    std::size_t number = 0;
    if (block.starts_with("Node_") && std::from_chars(block.data() + 5, block.data() + block.size(), number).ec == std::errc{} &&
        number < checked.partNames.size())
      node = checked.partNames[number], placement = checked.placements[number];
    if (auto* leaf = vtkPolyData::SafeDownCast(at->GetCurrentDataObject())) builder.add(leaf, {}, node, placement);
  }
  builder.turnFromGltf();
}

}  // namespace

vtkStandardNewMacro(Complaints)

    Location placeIn(const std::string& file, const std::string& complaint) {
  int line = 0, column = -1;
  if (std::sscanf(complaint.c_str(), "Error parsing XML in stream at line %d, column %d", &line, &column) != 2) return {file};
  return {file, line, column + 1};
}

Mesh readWithVtk(const std::string& file, const std::string& extension, std::string_view bytes, const CheckedFile& checked) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<Complaints> complaints;
  vtkOutputWindow::SetInstance(complaints);
  MeshBuilder builder(file);
  const MemoryFile copy(bytes);
  const std::string name = copy.name();
  if (extension == ".obj") readOne<vtkOBJReader>(name, checked, builder);
  else if (extension == ".stl") readOne<vtkSTLReader>(name, checked, builder);
  else if (extension == ".ply") readOne<vtkPLYReader>(name, checked, builder);
  else if (extension == ".vtp") readOne<vtkXMLPolyDataReader>(name, checked, builder);
  else readGltf(copy, checked, builder);
  if (!complaints->first.empty()) throw ImportFailure{placeIn(file, complaints->first), "the reader says: " + complaints->first, "a sound file", ""};
  return builder.take();
}

}  // namespace pitviper
