#include "sim/gl/objects.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdlib>
#include <cstring>

#include "sim/gl/context.hpp"
#include "sim/gl/sampler_slots.hpp"
#include "sim/gl/timing.hpp"

namespace pitviper {

void deleteProgram(unsigned n) { glDeleteProgram(n); }
void deleteBuffer(unsigned n) { glDeleteBuffers(1, &n); }
void deleteTexture(unsigned n) { glDeleteTextures(1, &n); }
void deleteFramebuffer(unsigned n) { glDeleteFramebuffers(1, &n); }
void deleteVertexArray(unsigned n) { glDeleteVertexArrays(1, &n); }
void deleteQuery(unsigned n) { glDeleteQueries(1, &n); }

Framebuffer makeFramebuffer() {
  GLuint n = 0;
  glCreateFramebuffers(1, &n);
  return Framebuffer(n);
}

VertexArray makeVertexArray() {
  GLuint n = 0;
  glCreateVertexArrays(1, &n);
  return VertexArray(n);
}

namespace {

std::atomic<long> gPrograms{0}, gLines{0};

/// llvmpipe compiles a program again for textures of other kinds of sizes: whether a side is a power of two and, of a buffer, whether bits 8 to 15 of its
/// bytes are all 0 (lp_sampler_static_texture_state() of Mesa takes them for a texture's last level). So no side is one below the largest that every driver of
/// OpenGL 4.5 has, and those bits never are.
int storedSide(int side) {
  constexpr int kLargest = 16384;
  return side + (side < kLargest && std::has_single_bit(static_cast<unsigned>(side)) ? 1 : 0);
}

std::size_t storedBytes(std::size_t bytes) {
  std::size_t stored = (std::max<std::size_t>(bytes, 1) + 15) / 16 * 16;
  if ((stored >> 8 & 0xff) == 0) stored += 0x100;
  return stored + (std::has_single_bit(stored) ? 16 : 0);
}

GLuint compile(GLenum stage, const AssembledShader& shader) {
  gLines += std::count(shader.source.begin(), shader.source.end(), '\n');
  const GLuint s = glCreateShader(stage);
  const char* text = shader.source.c_str();
  glShaderSource(s, 1, &text, nullptr);
  glCompileShader(s);
  GLint ok = 0;
  glGetShaderiv(s, GL_COMPILE_STATUS, &ok);
  if (ok) return s;
  GLint length = 0;
  glGetShaderiv(s, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(s, length, nullptr, log.data());
  glDeleteShader(s);
  throw GlError("shader does not compile:\n" + shader.mapLog(log.data()));
}

/// What memory of the driver's holds that nobody has written, where PITVIPER_POISON is set: no number. Drivers without a GPU give zeros, GPUs what the last
/// program left there.
constexpr GLuint kPoison = 0xffffffffu;
bool isPoisoned() {
  static const bool is = std::getenv("PITVIPER_POISON") != nullptr;
  return is;
}

}  // namespace

ProgramCount programsSoFar() { return {gPrograms, gLines}; }

Program::Program(AssembledShader vertex, AssembledShader fragment) : text_(fragment.source) {
  stages_.emplace_back(GL_VERTEX_SHADER, std::move(vertex));
  stages_.emplace_back(GL_FRAGMENT_SHADER, std::move(fragment));
}

Program::Program(AssembledShader compute) : text_(compute.source) { stages_.emplace_back(GL_COMPUTE_SHADER, std::move(compute)); }

void Program::make() const {
  if (isMade() || stages_.empty()) return;
  const TimedPart part(kProgramsPart);
  std::vector<GLuint> compiled;
  for (const auto& [stage, shader] : stages_) compiled.push_back(compile(stage, shader));
  GlName<deleteProgram> made(glCreateProgram());
  for (GLuint stage : compiled) glAttachShader(made, stage);
  glLinkProgram(made);
  // A driver keeps what it made of a text as long as that is attached.
  for (GLuint stage : compiled) {
    glDetachShader(made, stage);
    glDeleteShader(stage);
  }
  GLint ok = 0;
  glGetProgramiv(made, GL_LINK_STATUS, &ok);
  if (!ok) {
    char log[4096] = "";
    glGetProgramInfoLog(made, sizeof log, nullptr, log);
    throw GlError("shader program does not link:\n" + stages_.back().second.mapLog(log));
  }
  ++gPrograms;
  name_ = std::move(made);
  stages_.clear();
}

void Program::use() const {
  make();
  glUseProgram(name_);
}

int Program::uniform(const char* name) const {
  make();
  return glGetUniformLocation(name_, name);
}

void Buffer::upload(const void* data, std::size_t bytes) {
  if (!isSoftware()) {
    // Fresh storage each time: NVIDIA's driver (580.159) was seen to write a part of a buffer before it had cleared the whole, as it was told earlier.
    if (name_ == 0u) {
      GLuint n = 0;
      glCreateBuffers(1, &n);
      name_ = GlName<deleteBuffer>(n);
    }
    char few[16] = {};  // storage is never smaller
    if (bytes < sizeof few && bytes > 0 && data) std::memcpy(few, data, bytes);
    const bool isFew = bytes < sizeof few;
    glNamedBufferData(name_, static_cast<GLsizeiptr>(isFew ? sizeof few : bytes), isFew ? few : data, GL_DYNAMIC_DRAW);
    if (bytes != bytes_) texture_ = GlName<deleteTexture>();
    bytes_ = bytes;
    return;
  }
  if (name_ == 0u || bytes != bytes_) {
    GLuint n = 0;
    glCreateBuffers(1, &n);
    name_ = GlName<deleteBuffer>(n);
    glNamedBufferStorage(n, static_cast<GLsizeiptr>(storedBytes(bytes)), nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (isPoisoned()) glClearNamedBufferData(n, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &kPoison);
    bytes_ = bytes;
    texture_ = GlName<deleteTexture>();
  }
  if (bytes > 0 && data) glNamedBufferSubData(name_, 0, static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::uploadPart(std::size_t first, const void* data, std::size_t bytes) {
  if (isSoftware()) {
    glNamedBufferSubData(name_, static_cast<GLintptr>(first), static_cast<GLsizeiptr>(bytes), data);
    return;
  }
  Buffer staged;  // copied by the GPU, in its turn
  staged.upload(data, bytes);
  glCopyNamedBufferSubData(staged.name_, name_, 0, static_cast<GLintptr>(first), static_cast<GLsizeiptr>(bytes));
}

void Buffer::makeReadable(std::size_t bytes) {
  if (name_ != 0u && bytes == bytes_) return;
  GLuint n = 0;
  glCreateBuffers(1, &n);
  name_ = GlName<deleteBuffer>(n);
  glNamedBufferStorage(n, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 16)), nullptr, GL_MAP_READ_BIT | GL_CLIENT_STORAGE_BIT);
  bytes_ = bytes;
}

void Buffer::bindStorage(unsigned index) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, index, name_); }
void Buffer::bindUniform(unsigned index) const { glBindBufferBase(GL_UNIFORM_BUFFER, index, name_); }
void Buffer::bindTexture(unsigned unit, int perTexel, bool whole) const {
  if (texture_ == 0u) {
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &limit);
    const std::size_t texels = bytes_ / sizeof(float) / static_cast<std::size_t>(perTexel);
    if (texels > static_cast<std::size_t>(limit))
      throw GlError("a table of " + std::to_string(texels) + " entries is asked for, this driver's buffer textures hold " + std::to_string(limit) +
                    "; use smaller meshes, textures or tables of materials, or fewer spectral samples");
    GLuint n = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &n);
    texture_ = GlName<deleteTexture>(n);
    glTextureBuffer(n, whole ? perTexel == 4 ? GL_RGBA32UI : GL_R32UI : perTexel == 4 ? GL_RGBA32F : GL_R32F, name_);
  }
  glBindTextureUnit(unit, texture_);
}
void Buffer::bindImage(unsigned unit) const {
  bindTexture(unit, 4);
  glBindImageTexture(unit, texture_, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
}
void Buffer::reserve(std::size_t bytes) {
  if (name_ == 0u || bytes > bytes_) upload(nullptr, bytes);
}
void Buffer::fill(std::uint32_t value) const { glClearNamedBufferData(name_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value); }
void Buffer::read(void* into, std::size_t bytes) const { glGetNamedBufferSubData(name_, 0, static_cast<GLsizeiptr>(bytes), into); }
void Buffer::bindPack() const { glBindBuffer(GL_PIXEL_PACK_BUFFER, name_); }
void Buffer::download(void* into, std::size_t bytes) const {
  if (bytes == 0) return;
  if (const void* mapped = glMapNamedBufferRange(name_, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT)) std::memcpy(into, mapped, bytes);
  glUnmapNamedBuffer(name_);
}
void Buffer::bindVertices() const {
  glBindVertexBuffer(0, name_, 0, 4 * sizeof(float));
  glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexAttribIFormat(1, 1, GL_UNSIGNED_INT, 3 * sizeof(float));
  for (GLuint attribute : {0u, 1u}) {
    glVertexAttribBinding(attribute, 0);
    glEnableVertexAttribArray(attribute);
  }
}
void Buffer::bindElements() const { glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, name_); }

Texture2D::Texture2D(int width, int height, PixelFormat format) : width_(width), height_(height) {
  GLuint n = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &n);
  name_ = GlName<deleteTexture>(n);
  const GLenum internal = format == PixelFormat::Rgba32f  ? GL_RGBA32F
                          : format == PixelFormat::Rg32f  ? GL_RG32F
                          : format == PixelFormat::R32f   ? GL_R32F
                          : format == PixelFormat::Rg32ui ? GL_RG32UI
                                                          : GL_DEPTH_COMPONENT32F;
  glTextureStorage2D(n, 1, internal, storedSide(width), storedSide(height));
  setNearest(n);
  if (!isPoisoned()) return;
  const bool whole = format == PixelFormat::Rg32ui, depth = format == PixelFormat::Depth32f;
  const float somewhere = 0.71875f;  // a depth is between 0 and 1
  const GLuint four[4] = {kPoison, kPoison, kPoison, kPoison};
  const void* values = depth ? static_cast<const void*>(&somewhere) : four;
  glClearTexImage(n, 0, depth ? GL_DEPTH_COMPONENT : whole ? GL_RG_INTEGER : GL_RGBA, whole ? GL_UNSIGNED_INT : GL_FLOAT, values);
}

void Texture2D::upload(const std::vector<float>& texels) const {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(name_, 0, 0, 0, width_, height_, GL_RED, GL_FLOAT, texels.data());
}

void Texture2D::download(std::vector<float>& texels) const {
  texels.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glGetTextureSubImage(name_, 0, 0, 0, 0, width_, height_, 1, GL_RED, GL_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(float)), texels.data());
}

void Texture2D::bind(unsigned unit) const { glBindTextureUnit(unit, name_); }

RenderTarget::RenderTarget(int width, int height, const std::vector<PixelFormat>& colours, bool depth) : width_(width), height_(height) {
  const GlLimits limits = currentLimits();
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  if (std::max(width, height) > limits.largestTexture)
    throw GlError("a picture of " + size + " subpixels is asked for, this driver's textures end at " + std::to_string(limits.largestTexture) +
                  " a side; lower the film's width or height, or 'samples'");
  if (colours.size() > static_cast<std::size_t>(limits.drawBuffers))
    throw GlError(std::to_string(colours.size()) + " targets are asked for, this driver draws into " + std::to_string(limits.drawBuffers) +
                  " at once; ask for fewer channels or truth layers");
  GLuint n = 0;
  glCreateFramebuffers(1, &n);
  name_ = GlName<deleteFramebuffer>(n);
  std::vector<GLenum> buffers;
  for (size_t i = 0; i < colours.size(); ++i) {
    colours_.emplace_back(width, height, colours[i]);
    glNamedFramebufferTexture(n, GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i), colours_.back().name(), 0);
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
  }
  if (depth) {
    depth_.emplace(width, height, PixelFormat::Depth32f);
    glNamedFramebufferTexture(n, GL_DEPTH_ATTACHMENT, depth_->name(), 0);
  }
  if (colours.empty() && !depth) {
    glNamedFramebufferParameteri(n, GL_FRAMEBUFFER_DEFAULT_WIDTH, width);
    glNamedFramebufferParameteri(n, GL_FRAMEBUFFER_DEFAULT_HEIGHT, height);
  }
  glNamedFramebufferDrawBuffers(n, static_cast<GLsizei>(buffers.size()), buffers.data());
  if (glCheckNamedFramebufferStatus(n, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw GlError("the driver cannot draw into " + std::to_string(colours.size()) + " targets of " + size +
                  " pixels in single precision; ask for fewer channels or truth layers, or a smaller film");
}

void RenderTarget::select(std::size_t first, std::size_t count) {
  if (selected_ == std::pair(first, count)) return;
  selected_ = {first, count};
  std::vector<GLenum> buffers(first, GL_NONE);
  for (std::size_t i = first; i < first + count; ++i) buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
  glNamedFramebufferDrawBuffers(name_, static_cast<GLsizei>(buffers.size()), buffers.data());
}

void RenderTarget::shareDepth(const RenderTarget& other) {
  if (sharedDepth_ == other.depth().name()) return;
  sharedDepth_ = other.depth().name();
  glNamedFramebufferTexture(name_, GL_DEPTH_ATTACHMENT, sharedDepth_, 0);
}

void RenderTarget::setPart(const glm::ivec4& part) const {
  const bool whole = part.z == 0;
  glViewport(part.x, part.y, whole ? width_ : part.z, whole ? height_ : part.w);
  if (whole) {
    glDisable(GL_SCISSOR_TEST);
  } else {
    glEnable(GL_SCISSOR_TEST);
    glScissor(part.x, part.y, part.z, part.w);
  }
}

void RenderTarget::copyFrom(const RenderTarget& other) {
  for (std::size_t i = 0; i < colours_.size(); ++i)
    glCopyImageSubData(other.colour(i).name(), GL_TEXTURE_2D, 0, 0, 0, 0, colours_[i].name(), GL_TEXTURE_2D, 0, 0, 0, 0, width_, height_, 1);
}

void RenderTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, name_);
  glViewport(0, 0, width_, height_);
}

UnseenDraws::UnseenDraws() {
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 0, 0);
}
UnseenDraws::~UnseenDraws() { glDisable(GL_SCISSOR_TEST); }

DepthLayers::DepthLayers(int size, int count) : size_(size), count_(count) {
  GLuint n = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &n);
  texture_ = GlName<deleteTexture>(n);
  glTextureStorage3D(n, 1, GL_DEPTH_COMPONENT32F, size, size, count);
  setNearest(n);
  glCreateFramebuffers(1, &n);
  framebuffer_ = GlName<deleteFramebuffer>(n);
  glNamedFramebufferDrawBuffer(n, GL_NONE);
  glNamedFramebufferTextureLayer(n, GL_DEPTH_ATTACHMENT, texture_, 0, 0);
  if (glCheckNamedFramebufferStatus(n, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw GlError("the driver cannot draw into " + std::to_string(count) + " depth textures of " + std::to_string(size) + "x" + std::to_string(size));
}

void DepthLayers::grow(int count) {
  DepthLayers larger(size_, count);
  glCopyImageSubData(texture_, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, larger.texture_, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, size_, size_, count_);
  *this = std::move(larger);
}

void DepthLayers::bindForDrawing(int layer) const {
  glNamedFramebufferTextureLayer(framebuffer_, GL_DEPTH_ATTACHMENT, texture_, 0, layer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, size_, size_);
}

void DepthLayers::bind(unsigned unit) const { glBindTextureUnit(unit, texture_); }

void drawFullScreen(const RenderTarget& target, const Program& program, const std::vector<std::pair<const char*, float>>& uniforms) {
  const VertexArray empty = makeVertexArray();
  target.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(empty);
  program.use();
  for (const auto& [name, value] : uniforms) glUniform1f(program.uniform(name), value);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  checkGl("drawing a full screen");
}

void Readback::copy(Buffer& into, const RenderTarget& from, unsigned attachment, unsigned format, unsigned type, const glm::ivec4& part,
                    std::size_t bytesEach) {
  const std::size_t bytes = static_cast<std::size_t>(part.z) * static_cast<std::size_t>(part.w) * bytesEach;
  into.makeReadable(bytes);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from.name());
  glReadBuffer(attachment);
  into.bindPack();
  glReadPixels(part.x, part.y, part.z, part.w, format, type, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void Readback::start(const RenderTarget& target, std::size_t count, const RenderTarget* identityOf) {
  const glm::ivec4 whole(0, 0, target.width(), target.height());
  if (identityOf) copy(identity_, *identityOf, GL_COLOR_ATTACHMENT0, GL_RG_INTEGER, GL_UNSIGNED_INT, whole, 8);
  start(target, 0, count, whole);
  hasIdentity_ = identityOf != nullptr;
}

void Readback::start(const RenderTarget& target, std::size_t first, std::size_t count, const glm::ivec4& part) {
  pixels_ = static_cast<size_t>(part.z) * static_cast<size_t>(part.w);
  hasIdentity_ = false;
  // A driver without a GPU copies on this thread: beside threads that still draw it would take several times as long.
  if (isSoftware()) glFinish();
  colours_.resize(count);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  for (size_t i = 0; i < count; ++i) copy(colours_[i], target, GL_COLOR_ATTACHMENT0 + static_cast<unsigned>(first + i), GL_RGBA, GL_FLOAT, part, 16);
  if (fence_) glDeleteSync(static_cast<GLsync>(fence_));
  fence_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
}

Readback::Pixels Readback::wait() {
  if (fence_) {
    const auto sync = static_cast<GLsync>(fence_);
    while (glClientWaitSync(sync, GL_SYNC_FLUSH_COMMANDS_BIT, 1000000000) == GL_TIMEOUT_EXPIRED) {
    }
    glDeleteSync(sync);
    fence_ = nullptr;
  }
  Pixels out;
  for (auto& buffer : colours_) {
    out.colours.emplace_back(pixels_ * 4);
    buffer.download(out.colours.back().data(), pixels_ * 16);
  }
  if (hasIdentity_) {
    out.identity.resize(pixels_ * 2);
    identity_.download(out.identity.data(), pixels_ * 8);
  }
  checkGl("reading back a frame");
  return out;
}

}  // namespace pitviper
