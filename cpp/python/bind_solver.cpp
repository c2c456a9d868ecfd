#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "bind.hpp"
#include "bind_method.hpp"
#include "gimpslope/solver.hpp"

using namespace gimpslope;

namespace {

/// A solver that one thread at a time may use: stepping goes on without the interpreter's lock.
struct Guarded {
  Solver solver;
  std::vector<Row> rows;  // since they were last taken
  bool stepping = false;

  Solver& get() {
    if (stepping) throw std::runtime_error("the solver is stepping in another thread");
    return solver;
  }
};

std::unique_ptr<Guarded> make(
    const Doubles& position, const Doubles& velocity, const Doubles& half_length,
    const Doubles& mass, const Doubles& volume, const py::array& material,
    std::vector<Material> materials, double cell, std::array<double, 2> origin,
    const std::array<WallTuple, 4>& walls, const std::optional<py::array>& stone,
    const std::string& shape, const std::string& domain_update, const std::string& volume_update,
    const std::string& volumetric_strain, const std::string& scheme, const std::string& transfer,
    int order, const Choice& blended, const Choice& step, const std::string& precision, int threads,
    bool allow_unstable, bool ledger, const std::string& instruction_set) {
  Method method;
  method.shape = shape;
  method.domain_update =
      parse<DomainUpdate>("domain_update", domain_update,
                          {{"none", DomainUpdate::none},
                           {"jacobian", DomainUpdate::jacobian},
                           {"stretch", DomainUpdate::stretch},
                           {"deformation_diagonal", DomainUpdate::deformation_diagonal}});
  method.volume_update = volume_update_of(volume_update);
  method.volumetric_strain = parse<VolumetricStrain>(
      "volumetric_strain", volumetric_strain,
      {{"point", VolumetricStrain::point}, {"cell_average", VolumetricStrain::cell_average}});
  method.scheme = parse<SchemeKind>(
      "scheme", scheme,
      {{"usf", SchemeKind::usf}, {"usl", SchemeKind::usl}, {"musl", SchemeKind::musl}});
  method.transfer = parse<Transfer>(
      "transfer", transfer,
      {{"flip", Transfer::flip}, {"apic", Transfer::apic}, {"xpic", Transfer::xpic}});
  method.order = order;
  method.blend = blend_of(blended);
  method.time_step = time_step_of(step);
  method.precision = parse<Precision>(
      "precision", precision, {{"double", Precision::double_}, {"single", Precision::single}});
  method.threads = threads;
  method.allow_unstable = allow_unstable;
  method.ledger = ledger;
  const GivenPoints given(position, velocity, half_length, mass, volume, material,
                          stone ? &*stone : nullptr);
  return std::unique_ptr<Guarded>(
      new Guarded{Solver(given.points, std::move(materials), cell, origin, walls_of(walls), method,
                         instruction_set_of(instruction_set)),
                  {}});
}

constexpr std::pair<const char*, double Energies::*> kEnergies[] = {
    {"kinetic", &Energies::kinetic},
    {"potential", &Energies::potential},
    {"elastic", &Energies::elastic},
    {"max_speed", &Energies::max_speed}};

constexpr std::pair<const char*, double Ledger::*> kLedger[] = {
    {"plastic", &Ledger::plastic},         {"friction", &Ledger::friction},
    {"impact", &Ledger::impact},           {"damping", &Ledger::damping},
    {"transfer", &Ledger::transfer},       {"external", &Ledger::external},
    {"hypoelastic", &Ledger::hypoelastic}, {"integration", &Ledger::integration},
    {"rigidity", &Ledger::rigidity}};

/// The members of a struct by their names.
template <class Struct, std::size_t count>
py::dict by_name(const Struct& values,
                 const std::pair<const char*, double Struct::*> (&names)[count]) {
  py::dict result;
  for (const auto& [name, member] : names) result[name] = values.*member;
  return result;
}

/// x, y, angle, their rates, impulse x, y and angular impulse of each body: shape (rows, bodies,
/// 9).
py::array_t<double> bodies_of(std::span<const std::vector<BodyState>* const> rows) {
  const std::size_t bodies = rows.empty() ? 0 : rows.front()->size();
  py::array_t<double> result({rows.size(), bodies, std::size_t{9}});
  double* out = result.mutable_data();
  for (const auto* row : rows)
    for (const BodyState& b : *row)
      for (const double value : {b.centre[0], b.centre[1], b.angle, b.velocity[0], b.velocity[1],
                                 b.spin, b.impulse[0], b.impulse[1], b.angular_impulse})
        *out++ = value;
  return result;
}

/// One array a column.
py::dict take_rows(Guarded& guarded) {
  const bool ledger = guarded.get().keeps_ledger();
  const std::vector<Row> rows = std::exchange(guarded.rows, {});
  const auto column = [&](auto value) {
    py::array_t<decltype(value(Row{}))> values(static_cast<py::ssize_t>(rows.size()));
    std::transform(rows.begin(), rows.end(), values.mutable_data(), value);
    return values;
  };
  py::dict result;
  result["time"] = column([](const Row& row) { return row.time; });
  result["step"] = column([](const Row& row) { return row.steps; });
  for (const auto& [name, member] : kEnergies)
    result[name] = column([member = member](const Row& row) { return row.energies.*member; });
  if (!guarded.solver.bodies().empty()) {
    std::vector<const std::vector<BodyState>*> states;
    for (const Row& row : rows) states.push_back(&row.bodies);
    result["rigid_stones"] = bodies_of(states);
  }
  if (!ledger) return result;
  for (const auto& [name, member] : kLedger)
    result[name] = column([member = member](const Row& row) { return row.ledger.*member; });
  return result;
}

/// Runs chunk(solver, steps) -> finished without the interpreter's lock, in pieces of about a
/// twentieth of a second, and looks for Ctrl-C in between.
template <class Chunk>
void interruptible(Guarded& guarded, std::int64_t steps, Chunk chunk) {
  using Clock = std::chrono::steady_clock;
  constexpr double pause = 0.05;
  Solver& solver = guarded.get();
  struct Mark {
    bool& flag;
    explicit Mark(bool& f) : flag(f) { flag = true; }
    ~Mark() { flag = false; }
  } mark(guarded.stepping);
  for (std::int64_t piece = 1; steps > 0;) {
    const std::int64_t now = std::min(piece, steps);
    const auto start = Clock::now();
    bool finished;
    {
      py::gil_scoped_release release;
      finished = chunk(solver, now);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (finished) return;
    steps -= now;
    const double spent = std::chrono::duration<double>(Clock::now() - start).count();
    if (spent < 0.5 * pause) piece *= 2;
    if (spent > 2.0 * pause && piece > 1) piece /= 2;
  }
}

/// A window onto a field in storage order; it keeps the solver alive.
py::array window(py::object owner, const std::string& name) {
  auto& solver = owner.cast<Guarded&>().get();
  const FieldView f = solver.watch(name);
  constexpr auto size = static_cast<py::ssize_t>(sizeof(double));
  std::vector<py::ssize_t> shape{solver.size()}, strides{f.point_stride * size};
  if (f.components > 1) {
    shape.push_back(f.components);
    strides.push_back(f.component_stride * size);
  }
  py::array_t<double> array(shape, strides, f.data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

template <class Out>
py::array_t<Out> values(Guarded& guarded, const std::string& name) {
  Solver& solver = guarded.get();
  std::vector<py::ssize_t> shape{solver.size()};
  if (const int components = solver.field(name).components; components > 1)
    shape.push_back(components);
  py::array_t<Out> result(shape);
  solver.copy_values(name,
                     std::span(result.mutable_data(), static_cast<std::size_t>(result.size())));
  return result;
}

}  // namespace

void bind_solver(py::module_& m) {
  static py::exception<Diverged> diverged(m, "Diverged", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Diverged& error) {
      py::object instance = py::reinterpret_borrow<py::object>(diverged)(error.what());
      instance.attr("step") = error.step;
      instance.attr("time") = error.time;
      instance.attr("point") = error.point;
      PyErr_SetObject(diverged.ptr(), instance.ptr());
    }
  });

  const auto read = [](auto member) {
    return [member](Guarded& s) {
      return (s.get().*member)();
    };
  };
  py::class_<Guarded>(m, "Solver", "State of a scene and its stepping.")
      .def(py::init(&make), py::arg("position"), py::arg("velocity"), py::arg("half_length"),
           py::arg("mass"), py::arg("volume"), py::arg("material"), py::arg("materials"),
           py::kw_only(), py::arg("cell"), py::arg("origin"), py::arg("walls"),
           py::arg("stone") = py::none(), py::arg("shape") = "ugimp",
           py::arg("domain_update") = "none", py::arg("volume_update") = "linear",
           py::arg("volumetric_strain") = "point", py::arg("scheme") = "usf",
           py::arg("transfer") = "flip", py::arg("order") = 1,
           py::arg("blend") = Choice{"alpha", Blend{}.value},
           py::arg("time_step") = Choice{"courant", TimeStep{}.value},
           py::arg("precision") = "double", py::arg("threads") = Method{}.threads,
           py::arg("allow_unstable") = false, py::arg("ledger") = false,
           py::arg("instruction_set") = "")
      .def(
          "advance",
          [](Guarded& s, std::int64_t steps) {
            require(steps >= 0, "steps", steps, "zero or positive");
            interruptible(s, steps, [](Solver& solver, std::int64_t now) {
              solver.advance(now);
              return false;
            });
          },
          py::arg("steps") = 1)
      .def(
          "advance_to",
          [](Guarded& s, double time) {
            interruptible(s, INT64_MAX, [time](Solver& solver, std::int64_t now) {
              return solver.advance_to(time, now);
            });
          },
          py::arg("time"))
      .def(
          "advance_through",
          [](Guarded& s, const Doubles& times) {
            const std::span<const double> wanted = values_of(times, "times", rows_of(times), 1);
            interruptible(s, INT64_MAX, [&](Solver& solver, std::int64_t now) {
              return solver.advance_through(wanted, now, s.rows);
            });
          },
          py::arg("times"))
      .def("take_rows", &take_rows)
      .def(
          "set_gravity",
          [](Guarded& s, double x, double y, double ramp) { s.get().set_gravity({x, y, ramp}); },
          py::arg("x"), py::arg("y"), py::arg("ramp") = 0.0)
      .def(
          "set_damping",
          [](Guarded& s, double local, bool kinetic) { s.get().set_damping({local, kinetic}); },
          py::arg("local") = 0.0, py::arg("kinetic") = false)
      .def(
          "set_time_step",
          [](Guarded& s, const std::string& kind, double value) {
            s.get().set_time_step(time_step_of({kind, value}));
          },
          py::arg("kind"), py::arg("value"))
      .def(
          "set_materials",
          [](Guarded& s, std::vector<Material> given) { s.get().set_materials(std::move(given)); },
          py::arg("materials"))
      .def("release_stress", read(&Solver::release_stress))
      .def("stop", read(&Solver::stop))
      .def("reset_clock", read(&Solver::reset_clock))
      .def("energies", [](Guarded& s) { return by_name(s.get().energies(), kEnergies); })
      .def("ledger", [](Guarded& s) { return by_name(s.get().ledger(), kLedger); })
      .def("bodies",
           [](Guarded& s) {
             const auto* now = &s.get().bodies().states();
             return bodies_of(std::span(&now, 1));
           })
      .def("unsettled",
           [](Guarded& s) {
             const Bodies& bodies = s.get().bodies();
             const auto told = [](const Unsettled& of) {
               return py::make_tuple(of.steps, of.largest, of.sum);
             };
             return py::dict(py::arg("interfaces") = told(bodies.interfaces_unsettled()),
                             py::arg("contacts") = told(bodies.contacts_unsettled()));
           })
      .def("body_numbers",
           [](Guarded& s) {
             const auto& found = s.get().bodies().numbers();
             return py::array_t<std::int32_t>(static_cast<py::ssize_t>(found.size()), found.data());
           })
      .def("get", &values<double>, py::arg("name"))
      .def("get_single", &values<float>, py::arg("name"))
      .def(
          "set",
          [](Guarded& s, const std::string& name, const Doubles& given) {
            Solver& solver = s.get();
            solver.set_values(
                name, values_of(given, name.c_str(), solver.size(), solver.field(name).components));
          },
          py::arg("name"), py::arg("values"))
      .def("view", &window, py::arg("name"))
      .def("material",
           [](Guarded& s) {
             const auto found = s.get().material_of_points();
             return py::array_t<std::int32_t>(static_cast<py::ssize_t>(found.size()), found.data());
           })
      .def("numbers",
           [](py::object owner) {
             const auto numbers = owner.cast<Guarded&>().get().numbers();
             py::array_t<std::int32_t> array(static_cast<py::ssize_t>(numbers.size()),
                                             numbers.data(), owner);
             array.attr("setflags")(py::arg("write") = false);
             return array;
           })
      .def_property_readonly("time", read(&Solver::time))
      .def_property_readonly("steps", read(&Solver::steps))
      .def_property_readonly("size", read(&Solver::size))
      .def_property_readonly("threads", read(&Solver::threads))
      .def_property_readonly("instruction_set",
                             [](Guarded& s) { return name(s.get().instruction_set()); })
      .def_property_readonly("time_step", read(&Solver::time_step))
      .def_property_readonly("stable_time_step", read(&Solver::stable_time_step))
      .def_property_readonly("unbalanced_force", read(&Solver::unbalanced_force))
      .def_property_readonly("alpha", read(&Solver::alpha))
      .def_property_readonly("bytes", read(&Solver::bytes))
      .def_property_readonly("seconds", [](Guarded& s) {
        const Seconds& spent = s.get().seconds();
        return py::dict(py::arg("stress") = spent.stress, py::arg("move") = spent.move,
                        py::arg("nodes") = spent.nodes, py::arg("sort") = spent.sort);
      });
}
