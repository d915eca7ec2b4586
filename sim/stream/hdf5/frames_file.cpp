#include "sim/stream/hdf5/frames_file.hpp"

#include <hdf5.h>

#include <array>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace pitviper {
namespace {

/// The library is not made for several threads at once.
std::mutex& oneAtATime() {
  static std::mutex mutex;
  return mutex;
}

/// What went wrong, where it did.
herr_t firstWords(unsigned, const H5E_error2_t* error, void* words) {
  auto& text = *static_cast<std::string*>(words);
  if (text.empty() && error->desc) text = error->desc;
  return 0;
}

[[noreturn]] void failHdf5(const std::string& what) {
  std::string words;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, firstWords, &words);
  throw std::runtime_error("cannot " + what + (words.empty() ? "" : ": " + words));
}

void needHdf5(herr_t result, const char* what) {
  if (result < 0) failHdf5(what);
}

/// Closed with it.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*closer)(hid_t), const char* what) : id_(id), close_(closer) {
    if (id < 0) failHdf5(what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  hid_t get() const { return id_; }
  /// Errors of a full disk show here.
  void close(const char* what) {
    if (id_ >= 0) needHdf5(close_(std::exchange(id_, -1)), what);
  }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

Handle textType() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type");
  needHdf5(H5Tset_size(type.get(), H5T_VARIABLE), "make a type");
  needHdf5(H5Tset_cset(type.get(), H5T_CSET_UTF8), "make a type");
  return type;
}

Handle spaceOf(const std::vector<hsize_t>& sizes) {
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose, "make a space"};
}

void addText(hid_t object, const std::string& name, const std::string& value) {
  const Handle type = textType(), space(H5Screate(H5S_SCALAR), H5Sclose, "make a space");
  const Handle attribute(H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "make an attribute");
  const char* text = value.c_str();
  needHdf5(H5Awrite(attribute.get(), type.get(), &text), "write an attribute");
}

/// Without the time at which it was made: the same frames give the same bytes.
Handle timeless(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose, "make a list of properties");
  needHdf5(H5Pset_obj_track_times(list.get(), false), "make a list of properties");
  return list;
}

Handle addNumbers(hid_t place, const std::string& name, hid_t inFile, hid_t inMemory, const std::vector<hsize_t>& sizes, const void* values) {
  const Handle space = spaceOf(sizes), list = timeless(H5P_DATASET_CREATE);
  Handle set(H5Dcreate2(place, name.c_str(), inFile, space.get(), H5P_DEFAULT, list.get(), H5P_DEFAULT), H5Dclose, "make a dataset");
  needHdf5(H5Dwrite(set.get(), inMemory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write a dataset");
  return set;
}

void addTexts(hid_t place, const std::string& name, const std::vector<std::string>& texts) {
  const Handle type = textType();
  std::vector<const char*> pointers;
  for (const std::string& t : texts) pointers.push_back(t.c_str());
  addNumbers(place, name, type.get(), type.get(), {texts.size()}, pointers.data());
}

class FramesFile final : public Hdf5Frames {
 public:
  explicit FramesFile(const Hdf5Request& request) : width_(static_cast<hsize_t>(request.width)), height_(static_cast<hsize_t>(request.height)) {
    const std::lock_guard lock(oneAtATime());
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are told by what is thrown
    const Handle list = timeless(H5P_FILE_CREATE);
    file_ = Handle(H5Fcreate(request.file.c_str(), H5F_ACC_TRUNC, list.get(), H5P_DEFAULT), H5Fclose, "make the file");
    for (const auto& [name, unit] : request.layers) {
      const std::array<hsize_t, 3> none = {0, height_, width_}, most = {H5S_UNLIMITED, height_, width_}, chunk = {1, height_, width_};
      const Handle space(H5Screate_simple(3, none.data(), most.data()), H5Sclose, "make a space"), own = timeless(H5P_DATASET_CREATE);
      needHdf5(H5Pset_chunk(own.get(), 3, chunk.data()), "make chunks of a frame");
      if (request.compression > 0) {
        needHdf5(H5Pset_shuffle(own.get()), "shuffle bytes");
        needHdf5(H5Pset_deflate(own.get(), static_cast<unsigned>(request.compression)), "compress");
      }
      layers_.emplace_back(H5Dcreate2(file_.get(), name.c_str(), H5T_IEEE_F32LE, space.get(), H5P_DEFAULT, own.get(), H5P_DEFAULT), H5Dclose, "make a dataset");
      addText(layers_.back().get(), "unit", unit);
    }
  }
  ~FramesFile() override {
    const std::lock_guard lock(oneAtATime());
    layers_.clear();
    file_ = {};
  }

  void add(const std::vector<std::span<const float>>& layers) override {
    const std::lock_guard lock(oneAtATime());
    const std::array<hsize_t, 3> all = {frames_ + 1, height_, width_}, from = {frames_, 0, 0}, one = {1, height_, width_};
    const Handle memory(H5Screate_simple(3, one.data(), nullptr), H5Sclose, "make a space");
    for (std::size_t l = 0; l < layers_.size(); ++l) {
      if (layers.at(l).size() != width_ * height_) throw std::runtime_error("cannot write a layer that is not width x height");
      needHdf5(H5Dset_extent(layers_[l].get(), all.data()), "add a frame");
      const Handle file(H5Dget_space(layers_[l].get()), H5Sclose, "add a frame");
      needHdf5(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, from.data(), nullptr, one.data(), nullptr), "add a frame");
      needHdf5(H5Dwrite(layers_[l].get(), H5T_NATIVE_FLOAT, memory.get(), file.get(), H5P_DEFAULT, layers[l].data()), "write a frame");
    }
    ++frames_;
  }

  void finish(const Hdf5Ends& ends) override {
    const std::lock_guard lock(oneAtATime());
    if (ends.numbers.size() != frames_ || ends.times_s.size() != frames_) throw std::runtime_error("cannot write numbers and times that are not one a frame");
    for (const auto& [name, value] : ends.attributes) addText(file_.get(), name, value);
    addNumbers(file_.get(), "number", H5T_STD_I32LE, H5T_NATIVE_INT, {frames_}, ends.numbers.data());
    const Handle times = addNumbers(file_.get(), "time_s", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {frames_}, ends.times_s.data());
    addText(times.get(), "unit", "s");
    if (!ends.targets.empty()) {
      const Handle list = timeless(H5P_GROUP_CREATE), group(H5Gcreate2(file_.get(), "targets", H5P_DEFAULT, list.get(), H5P_DEFAULT), H5Gclose, "make a group");
      addTexts(group.get(), "names", ends.targets);
      addTexts(group.get(), "kinds", ends.kinds);
      for (const Hdf5Table& t : ends.tables) {
        if (t.values.size() != frames_ * ends.targets.size()) throw std::runtime_error("cannot write a table that is not frames x targets");
        const Handle set = addNumbers(group.get(), t.name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {frames_, ends.targets.size()}, t.values.data());
        addText(set.get(), "unit", t.unit);
      }
    }
    for (Handle& layer : layers_) layer.close("finish a dataset");
    file_.close("finish the file");
  }

 private:
  hsize_t width_, height_, frames_ = 0;
  Handle file_;
  std::vector<Handle> layers_;
};

}  // namespace

std::unique_ptr<Hdf5Frames> makeFramesFile(const Hdf5Request& request) { return std::make_unique<FramesFile>(request); }

}  // namespace pitviper
