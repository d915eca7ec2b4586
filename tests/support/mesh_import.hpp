#pragma once
// Meshes imported from files that a test writes, with a cache of their own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/scene/mesh_import.hpp"

namespace pitviper::test {

struct MeshImport : testing::Test {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("pitviper_mesh_" + std::to_string(getpid()));
  MeshImport() {
    std::filesystem::create_directories(folder);
    setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
#ifdef PITVIPER_MESH_IMPORT_FOLDER
    setModuleFolder(PITVIPER_MESH_IMPORT_FOLDER);
#endif
  }
  ~MeshImport() override {
    std::filesystem::remove_all(folder);
    setenv("XDG_CACHE_HOME", before.c_str(), 1);
  }
  const std::string before = std::getenv("XDG_CACHE_HOME") != nullptr ? std::getenv("XDG_CACHE_HOME") : "";

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return folder / name;
  }
  /// What importMesh complains about.
  std::string complaint(const std::filesystem::path& file, double metresPerUnit = 1.0) const {
    try {
      importMesh(file, metresPerUnit, {"scene.yaml", 7, 3});
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }
  Mesh import(const std::string& name, const std::string& bytes, double metresPerUnit = 1.0) const { return importMesh(write(name, bytes), metresPerUnit, {}); }
};

}  // namespace pitviper::test
