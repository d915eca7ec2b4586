// What goes wrong, as Python's exceptions.
#include <new>
#include <string>

#include "scenarios/python/bindings.hpp"
#include "scenarios/session/open_scene.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"

namespace py = pybind11;

namespace pitviper {
namespace {

py::object& inputError() {
  static py::object* type = new py::object();  // outlives the interpreter, which takes its types with it
  return *type;
}

void raiseInputError(const UserError& e) {
  UserError::Parts p = e.parts();
  std::string message = e.what();
  // A key that was set here is no option of a command line.
  if (const std::string option = "--set "; p.where.file.starts_with(option)) {
    p.where.file = "scene key " + p.where.file.substr(option.size());
    message = "scene key " + message.substr(option.size());
  }
  py::object error = inputError()(message);
  const auto orNone = [](int value) -> py::object { return value > 0 ? py::object(py::int_(value)) : py::object(py::none()); };
  error.attr("file") = p.where.file;
  error.attr("line") = orNone(p.where.line);
  error.attr("column") = orNone(p.where.column);
  error.attr("wrong") = p.wrong;
  error.attr("expected") = p.expected;
  error.attr("fix") = p.fix;
  PyErr_SetObject(inputError().ptr(), error.ptr());
}

}  // namespace

void bindErrors(py::module_& m) {
  // A mistake is a wrong value to Python.
  inputError() = py::reinterpret_steal<py::object>(PyErr_NewExceptionWithDoc(
      "pitviper.InputError",
      "A mistake in what was given: a scenario, a key, a unit, a value. `file`, `line` and `column` say where (None: nowhere in a file), `wrong` what, "
      "`expected` what would have done, `fix` what to do; its text is all of that in a line.",
      PyExc_ValueError, nullptr));
  m.attr("InputError") = inputError();
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const UserError& e) {
      raiseInputError(e);
    } catch (const OutputError& e) {
      PyErr_SetString(PyExc_OSError, e.what());
    } catch (const SceneInterrupted&) {
      if (!PyErr_Occurred()) PyErr_SetNone(PyExc_KeyboardInterrupt);
    } catch (const GlError& e) {
      PyErr_SetString(PyExc_RuntimeError, e.what());
    }
  });
}

}  // namespace pitviper
