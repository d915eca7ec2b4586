// The module's border: two C functions, no exceptions out.
#include <cctype>
#include <filesystem>
#include <new>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/grid_reply.hpp"
#include "sim/scene/import/import_failure.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/vti_reader.hpp"
#include "sim/scene/import/vtk_readers.hpp"

namespace pitviper {
namespace {

/// Text without the mark that says it is UTF-8, which would be part of its first word.
std::string_view withoutMark(std::string_view bytes) { return bytes.substr(bytes.starts_with("\xef\xbb\xbf") ? 3 : 0); }

Mesh import(const ImportRequest& request) {
  const std::string& file = request.file;
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (request.bytes.empty()) throw ImportFailure{{file}, "the file is empty", "a mesh", ""};
  CheckedFile checked;
  if (extension == ".obj") checked = checkObj(file, withoutMark(request.bytes));
  else if (extension == ".stl") checked = checkStl(file, withoutMark(request.bytes));
  else if (extension == ".ply") checked = checkPly(file, withoutMark(request.bytes));
  else if (extension == ".vtp") checked = checkVtp(file, request.bytes);
  else checked = checkGltf(request);
  Mesh mesh = readWithVtk(file, extension, checked.bytes.empty() ? request.bytes : checked.bytes, checked);
  if (mesh.triangles.empty()) throw ImportFailure{{file}, "the file has no triangles", "at least one", ""};
  return mesh;
}

}  // namespace
}  // namespace pitviper

extern "C" __attribute__((visibility("default"))) void pitviperImportMesh(const pitviper::ImportRequest& request, pitviper::ImportReply* reply) {
  const auto failed = [&](const pitviper::Location& where, const std::string& wrong, const std::string& expected, const std::string& fix) {
    reply->mesh = {};
    reply->failed = true;
    reply->where = where;
    reply->wrong = wrong;
    reply->expected = expected;
    reply->fix = fix;
  };
  try {
    reply->mesh = pitviper::import(request);
  } catch (const pitviper::ImportFailure& failure) {
    failed(failure.where, failure.wrong, failure.expected, failure.fix);
  } catch (const std::bad_alloc&) {
    failed({request.file}, "reading this file takes too much memory", "at most 1 GiB and sixteen times its size", "simplify the mesh");
  } catch (const std::exception& problem) {
    failed({request.file}, std::string("the reader failed on this file (") + problem.what() + ")", "a sound file", "");
  }
}

extern "C" __attribute__((visibility("default"))) void pitviperImportGrid(const pitviper::GridRequest& request, pitviper::GridReply* reply) {
  try {
    pitviper::checkVti(request.file, request.bytes);
    reply->grid = pitviper::readVti(request);
  } catch (const pitviper::ImportFailure& failure) {
    *reply = {{}, true, failure.where, failure.wrong, failure.expected, failure.fix};
  } catch (const std::bad_alloc&) {
    *reply = {{}, true, {request.file}, "reading this file takes too much memory", "at most 1 GiB and sixteen times its size", "thin the grid out"};
  } catch (const std::exception& problem) {
    *reply = {{}, true, {request.file}, std::string("the reader failed on this file (") + problem.what() + ")", "a sound file", ""};
  }
}
