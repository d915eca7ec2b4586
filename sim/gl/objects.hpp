#pragma once
// Owners of GL objects: program, buffer, texture, framebuffer, timer, readback. All need a current GlContext.
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/gl/shader_assembler.hpp"

namespace pitviper {

/// Moves, never copies; `Deleter` frees the name.
template <void (*Deleter)(unsigned)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(unsigned name) : name_(name) {}
  GlName(GlName&& o) noexcept : name_(o.name_) { o.name_ = 0; }
  GlName& operator=(GlName&& o) noexcept {
    std::swap(name_, o.name_);
    return *this;
  }
  ~GlName() {
    if (name_) Deleter(name_);
  }
  operator unsigned() const { return name_; }

 private:
  unsigned name_ = 0;
};

void deleteProgram(unsigned);
void deleteBuffer(unsigned);
void deleteTexture(unsigned);
void deleteFramebuffer(unsigned);
void deleteVertexArray(unsigned);
void deleteQuery(unsigned);

using VertexArray = GlName<deleteVertexArray>;
VertexArray makeVertexArray();
using Framebuffer = GlName<deleteFramebuffer>;
Framebuffer makeFramebuffer();

/// What this process has had compiled and linked so far: programs, and lines of the texts of all their stages.
struct ProgramCount {
  long programs = 0, lines = 0;
};
ProgramCount programsSoFar();

/// Part of the time (sim/gl/timing.hpp) in which programs are compiled and linked.
inline constexpr const char* kProgramsPart = "programs";

/// A program, compiled and linked when it is first used; errors are GlError with file:line of the project's shader files.
class Program {
 public:
  Program() = default;
  Program(AssembledShader vertex, AssembledShader fragment);
  explicit Program(AssembledShader compute);
  void use() const;
  int uniform(const char* name) const;
  bool isMade() const { return name_ != 0u; }
  /// Source of its fragment or compute stage; empty where there is no program.
  const std::string& text() const { return text_; }

 private:
  void make() const;
  mutable GlName<deleteProgram> name_;
  mutable std::vector<std::pair<unsigned, AssembledShader>> stages_;  ///< until it is made
  std::string text_;
};

class Buffer {
 public:
  /// Replaces the contents; storage is kept where the size is unchanged. Its storage is never empty, and somewhat more than asked for.
  void upload(const void* data, std::size_t bytes);
  template <class T>
  void upload(const std::vector<T>& data) {
    upload(data.data(), data.size() * sizeof(T));
  }
  /// Replaces a part [bytes] of what it has.
  void uploadPart(std::size_t first, const void* data, std::size_t bytes);
  void bindStorage(unsigned index) const;
  void bindUniform(unsigned index) const;
  void bindElements() const;
  /// Of the bound vertex array, for each vertex: attribute 0, three floats, and 1, a whole number behind them.
  void bindVertices() const;
  /// As a texture of floats or of whole numbers, one or four to a texel, read by texelFetch.
  void bindTexture(unsigned unit, int perTexel, bool whole = false) const;
  /// The same of four floats to a texel, for imageStore().
  void bindImage(unsigned unit) const;
  /// Storage of that size [bytes] that programs write; nothing is done where it has as much.
  void reserve(std::size_t bytes);
  /// Every number of it.
  void fill(std::uint32_t value) const;
  /// Its first bytes; waits for what writes them.
  void read(void* into, std::size_t bytes) const;
  /// Storage that a GPU writes and download() reads, of that size [bytes].
  void makeReadable(std::size_t bytes);
  void bindPack() const;
  /// The first bytes; waits for what is written into it.
  void download(void* into, std::size_t bytes) const;
  std::size_t bytes() const { return bytes_; }
  explicit operator bool() const { return name_ != 0u; }

 private:
  GlName<deleteBuffer> name_;
  mutable GlName<deleteTexture> texture_;  ///< view of the storage, made when first bound
  std::size_t bytes_ = 0;
};

enum class PixelFormat { Rgba32f, Rg32f, R32f, Rg32ui, Depth32f };

/// Its storage has a row or a column more where a side is a power of two: textureSize() is not its size.
class Texture2D {
 public:
  Texture2D() = default;
  Texture2D(int width, int height, PixelFormat format);
  void bind(unsigned unit) const;
  unsigned name() const { return name_; }
  /// Of R32f: all its texels, row by row from texel row 0 on. download() waits for what is drawn into it.
  void upload(const std::vector<float>& texels) const;
  void download(std::vector<float>& texels) const;

 private:
  GlName<deleteTexture> name_;
  int width_ = 0, height_ = 0;
};

/// A set of colour textures and, if asked for, a depth texture, all of one size.
class RenderTarget {
 public:
  RenderTarget() = default;
  RenderTarget(int width, int height, const std::vector<PixelFormat>& colours, bool depth);
  void bind() const;
  /// Draws into colours [first, first + count) only; output locations stay as they are.
  void select(std::size_t first, std::size_t count);
  /// Tests against another target's depth (of the same size) from now on; it must outlive this one's use.
  void shareDepth(const RenderTarget& other);
  /// Whole target, or a part: corner and size.
  void setPart(const glm::ivec4& part) const;
  /// Copies all colours of a target of the same size and formats.
  void copyFrom(const RenderTarget& other);
  const Texture2D& colour(std::size_t i) const { return colours_[i]; }
  const Texture2D& depth() const { return *depth_; }
  std::size_t colourCount() const { return colours_.size(); }
  int width() const { return width_; }
  int height() const { return height_; }
  unsigned name() const { return name_; }

 private:
  GlName<deleteFramebuffer> name_;
  std::vector<Texture2D> colours_;
  std::optional<Texture2D> depth_;
  int width_ = 0, height_ = 0;
  std::pair<std::size_t, std::size_t> selected_{0, 0};  ///< first, count; none: all
  unsigned sharedDepth_ = 0;
};

/// While it lives nothing that is drawn reaches a pixel, but a driver that compiles what is left of a program when it first draws does so.
class UnseenDraws {
 public:
  UnseenDraws();
  ~UnseenDraws();
  UnseenDraws(const UnseenDraws&) = delete;
  UnseenDraws& operator=(const UnseenDraws&) = delete;
};

/// Square depth textures of one size, single precision, drawn one at a time and read together.
class DepthLayers {
 public:
  DepthLayers() = default;
  /// Throws GlError where the driver has no such texture.
  DepthLayers(int size, int count);
  /// More of them; what is drawn into the first stays.
  void grow(int count);
  void bindForDrawing(int layer) const;
  void bind(unsigned unit) const;
  int count() const { return count_; }

 private:
  GlName<deleteTexture> texture_;
  GlName<deleteFramebuffer> framebuffer_;
  int size_ = 0, count_ = 0;
};

/// Runs a fragment program once per pixel of a target, with float uniforms by name. The vertex stage is the caller's.
void drawFullScreen(const RenderTarget& target, const Program& program, const std::vector<std::pair<const char*, float>>& uniforms);

/// Copies targets to pixel buffers without waiting; wait() gives the floats. Row 0 is the bottom row, as GL has it.
class Readback {
 public:
  /// Begins copying colour attachments [0, count) as RGBA floats; of another target of the same size, if given, the first colour as pairs of whole
  /// numbers.
  void start(const RenderTarget& target, std::size_t count, const RenderTarget* identityOf = nullptr);
  /// Of a part (corner, size), colours [first, first + count).
  void start(const RenderTarget& target, std::size_t first, std::size_t count, const glm::ivec4& part);
  struct Pixels {
    std::vector<std::vector<float>> colours;  ///< each width * height * 4
    std::vector<std::uint32_t> identity;      ///< width * height * 2, or empty
  };
  /// Blocks until the copy is done.
  Pixels wait();
  Readback() = default;
  Readback(Readback&&) = default;
  Readback& operator=(Readback&&) = default;

 private:
  void copy(Buffer& into, const RenderTarget& from, unsigned attachment, unsigned format, unsigned type, const glm::ivec4& part, std::size_t bytesEach);
  std::vector<Buffer> colours_;
  Buffer identity_;
  bool hasIdentity_ = false;
  std::size_t pixels_ = 0;
  void* fence_ = nullptr;
};

}  // namespace pitviper
