#pragma once
// An OpenGL 4.5 core context without a window, through EGL: Mesa's surfaceless platform, or an EGL device (NVIDIA).
#include <memory>
#include <stdexcept>
#include <string>

namespace pitviper {

/// No context, or the driver cannot do what is needed. The message says which limit and what will do.
class GlError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct GlLimits {
  std::string vendor, renderer, version;
  bool software = false;   ///< drawn by the CPU
  int largestTexture = 0;  ///< pixels a side
  int drawBuffers = 0;     ///< colour targets of one pass
  int uniformBlock = 0;    ///< bytes
};

/// Whose objects a further context of the same process shares: textures, buffers and programs.
struct SharedContext {
  void* display = nullptr;
  void* context = nullptr;
  static SharedContext ofCurrent();
};

/// Current on the thread that made it, until destroyed; then the one that was before is again. Not copyable.
class GlContext {
 public:
  /// `device`: "auto" takes the first hardware EGL device and falls back on surfaceless; "surfaceless"; or "device:N".
  /// The environment variable PITVIPER_GL overrides "auto". Throws GlError.
  explicit GlContext(std::string device = "auto");
  explicit GlContext(const SharedContext& shared);
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const GlLimits& limits() const { return limits_; }
  /// Current on no thread from here on; any may use it. Called on the thread it is current on.
  void release();

 private:
  friend class UsedContext;
  void begin();
  void* display_ = nullptr;
  void* context_ = nullptr;
  void* displayBefore_ = nullptr;
  void* before_ = nullptr;
  GlLimits limits_;
};

/// A context that was released, current on this thread while this lives; then the one that was before is again. Null: nothing changes.
class UsedContext {
 public:
  explicit UsedContext(const GlContext* context);
  ~UsedContext();
  UsedContext(const UsedContext&) = delete;
  UsedContext& operator=(const UsedContext&) = delete;

 private:
  bool isUsed_;
  void *display_ = nullptr, *before_ = nullptr, *displayBefore_ = nullptr;
};

/// Of the current context.
GlLimits currentLimits();

/// Whether the current context draws on the CPU; asks the driver once for each context.
bool isSoftware();

/// Throws GlError where a uniform block would be larger than the driver's; says what takes the room.
void checkUniformSize(std::size_t bytes, const char* what);

/// Throws GlError where GL has recorded an error; `doing` says at what.
void checkGl(const char* doing);

}  // namespace pitviper
