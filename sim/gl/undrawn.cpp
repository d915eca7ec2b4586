#include "sim/gl/undrawn.hpp"

#include <epoxy/gl.h>

namespace pitviper {
namespace {

/// A driver's function that does nothing in the meantime.
template <class... Values>
struct Silent {
  static void GLAPIENTRY call(Values...) {}
};

template <class... Values>
void silence(void(GLAPIENTRY*& function)(Values...), void (*&before)()) {
  before = reinterpret_cast<void (*)()>(function);
  function = &Silent<Values...>::call;
}

template <class... Values>
void restore(void(GLAPIENTRY*& function)(Values...), void (*before)()) {
  function = reinterpret_cast<void(GLAPIENTRY*)(Values...)>(before);
}

/// `act(function, its place)`.
void forAll(const auto& act) {
  act(epoxy_glDrawArrays, 0);
  act(epoxy_glDrawElements, 1);
  act(epoxy_glDrawElementsInstanced, 2);
  act(epoxy_glDispatchCompute, 3);
  act(epoxy_glClearBufferfv, 4);
  act(epoxy_glClearBufferuiv, 5);
  act(epoxy_glReadPixels, 6);
}

}  // namespace

Undrawn::Undrawn() {
  glFinish();
  forAll([this](auto& function, std::size_t k) { silence(function, before_[k]); });
}

Undrawn::~Undrawn() {
  forAll([this](auto& function, std::size_t k) { restore(function, before_[k]); });
}

}  // namespace pitviper
