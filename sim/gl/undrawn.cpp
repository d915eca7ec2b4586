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

}  // namespace

Undrawn::Undrawn() {
  glFinish();
  silence(epoxy_glDrawArrays, before_[0]);
  silence(epoxy_glDrawElements, before_[1]);
  silence(epoxy_glDrawElementsInstanced, before_[2]);
  silence(epoxy_glDispatchCompute, before_[3]);
  silence(epoxy_glClearBufferfv, before_[4]);
  silence(epoxy_glClearBufferuiv, before_[5]);
  silence(epoxy_glReadPixels, before_[6]);
}

Undrawn::~Undrawn() {
  restore(epoxy_glDrawArrays, before_[0]);
  restore(epoxy_glDrawElements, before_[1]);
  restore(epoxy_glDrawElementsInstanced, before_[2]);
  restore(epoxy_glDispatchCompute, before_[3]);
  restore(epoxy_glClearBufferfv, before_[4]);
  restore(epoxy_glClearBufferuiv, before_[5]);
  restore(epoxy_glReadPixels, before_[6]);
}

}  // namespace pitviper
