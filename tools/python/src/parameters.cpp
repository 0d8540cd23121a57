#include "tools/python/src/parameters.h"

#include <cmath>
#include <initializer_list>

namespace plc::python {

namespace {

struct Word {
  const char* word;
  int value;
};
using Words = std::initializer_list<Word>;

int value_of(const std::string& name, const std::string& word, Words words) {
  std::string known;
  for (const Word& w : words) {
    if (word == w.word) return w.value;
    known += (known.empty() ? "'" : ", '") + std::string(w.word) + "'";
  }
  throw py::value_error(name + " '" + word + "': must be one of " + known);
}

// Every field by its name, for both directions.
template <class Visitor>
void visit(plc_parameters& p, Visitor& v) {
  v.derived("iso", p.iso);
  v.flag("inside_below", p.inside_below);
  v.list("level_iso", p.level_iso, p.level_iso_count);
  v.derived("window_low", p.window_low);
  v.derived("window_high", p.window_high);
  v.derived("pad_value", p.pad_value);
  v.word("feature", p.feature,
         {{"none", PLC_FEATURE_NONE}, {"gradient_norm", PLC_FEATURE_GRADIENT_NORM}});
  v.number("feature_sigma", p.feature_sigma);
  v.count_or_none("levels", p.levels);
  v.number("reduction", p.reduction);
  v.word("init", p.init,
         {{"bubble", PLC_INIT_BUBBLE},
          {"bubbles", PLC_INIT_BUBBLES},
          {"seeds", PLC_INIT_SEEDS},
          {"iso", PLC_INIT_ISO},
          {"mask", PLC_INIT_MASK},
          {"mesh", PLC_INIT_MESH}});
  v.triple("bubbles", p.bubbles);
  v.number("curvature", p.curvature);
  v.number("spring", p.spring);
  v.word("rest_length", p.rest_length,
         {{"zero", PLC_REST_ZERO}, {"mean", PLC_REST_MEAN}, {"value", PLC_REST_VALUE}});
  v.number("rest_length_value", p.rest_length_value);
  v.word("force", p.force,
         {{"iso", PLC_FORCE_ISO}, {"gradient", PLC_FORCE_GRADIENT}, {"both", PLC_FORCE_BOTH}});
  v.number("attraction", p.attraction);
  v.number("gradient", p.gradient);
  v.number("gradient_tangent", p.gradient_tangent);
  v.number("gradient_bound", p.gradient_bound);
  v.number("mass", p.mass);
  v.number("damping", p.damping);
  v.number("time_step", p.time_step);
  v.number("max_move", p.max_move);
  v.word("bound", p.bound, {{"clamp", PLC_BOUND_CLAMP}, {"scale", PLC_BOUND_SCALE}});
  v.word("anisotropy", p.anisotropy,
         {{"physical", PLC_ANISOTROPY_PHYSICAL},
          {"voxel", PLC_ANISOTROPY_VOXEL},
          {"metric", PLC_ANISOTROPY_METRIC}});
  v.number("epsilon", p.epsilon);
  v.number("calm_speed", p.calm_speed);
  v.count("max_iterations", p.max_iterations);
  v.flag("late_bubbles", p.late_bubbles);
  v.flag("sleeping", p.sleeping);
}

class Writer {
 public:
  py::dict take() { return std::move(fields_); }
  void number(const char* name, double value) { fields_[name] = value; }
  void count(const char* name, int value) { fields_[name] = value; }
  void flag(const char* name, int value) { fields_[name] = value != 0; }
  void derived(const char* name, double value) {
    fields_[name] = std::isnan(value) ? py::object(py::none()) : py::float_(value);
  }
  void count_or_none(const char* name, int value) {
    fields_[name] = value < 0 ? py::object(py::none()) : py::int_(value);
  }
  void triple(const char* name, const int* values) {
    fields_[name] = py::make_tuple(values[0], values[1], values[2]);
  }
  void list(const char* name, const double* values, int count) {
    fields_[name] = py::none();
    if (count == 0) return;
    py::tuple all(count);
    for (int i = 0; i < count; ++i) all[static_cast<size_t>(i)] = values[i];
    fields_[name] = all;
  }
  template <class Enum>
  void word(const char* name, Enum value, Words words) {
    for (const Word& w : words) {
      if (w.value == static_cast<int>(value)) fields_[name] = w.word;
    }
  }

 private:
  py::dict fields_;
};

class Reader {
 public:
  explicit Reader(const py::dict& fields) : fields_(fields) {}

  void number(const char* name, double& value) { read(name, "a number", value); }
  void count(const char* name, int& value) { read(name, "an integer", value); }
  void flag(const char* name, int& value) {
    bool set = value != 0;
    read(name, "True or False", set);
    value = set ? 1 : 0;
  }
  void derived(const char* name, double& value) {
    if (none(name)) {
      value = NAN;
    } else {
      read(name, "a number or None", value);
    }
  }
  void count_or_none(const char* name, int& value) {
    if (none(name)) {
      value = -1;
    } else {
      read(name, "an integer or None", value);
    }
  }
  void triple(const char* name, int* values) {
    if (!fields_.contains(name)) return;
    const py::sequence all = sequence(name, "three integers");
    if (all.size() != 3) throw py::value_error(std::string(name) + ": must be three integers");
    for (size_t i = 0; i < 3; ++i) values[i] = cast<int>(name, "three integers", all[i]);
  }
  void list(const char* name, double* values, int& count) {
    count = 0;
    if (!fields_.contains(name) || none(name)) return;
    const py::sequence all = sequence(name, "numbers or None");
    if (all.size() > PLC_MAX_LEVELS) {
      throw py::value_error(std::string(name) + ": more values than there can be levels");
    }
    for (; count < static_cast<int>(all.size()); ++count) {
      values[count] = cast<double>(name, "numbers or None", all[static_cast<size_t>(count)]);
    }
    if (count == 0) throw py::value_error(std::string(name) + ": None where there are no values");
  }
  template <class Enum>
  void word(const char* name, Enum& value, Words words) {
    std::string given;
    read(name, "a string", given);
    if (fields_.contains(name)) value = static_cast<Enum>(value_of(name, given, words));
  }

 private:
  bool none(const char* name) const {
    return fields_.contains(name) && py::object(fields_[name]).is_none();
  }
  template <class T>
  void read(const char* name, const char* kind, T& value) {
    if (fields_.contains(name)) value = cast<T>(name, kind, py::object(fields_[name]));
  }
  template <class T>
  static T cast(const char* name, const char* kind, const py::object& value) {
    try {
      return value.cast<T>();
    } catch (const py::cast_error&) {
      throw py::type_error(std::string(name) + ": must be " + kind + ", not " +
                           py::repr(value).cast<std::string>());
    }
  }
  py::sequence sequence(const char* name, const char* kind) const {
    py::object value = fields_[name];
    if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) {
      throw py::type_error(std::string(name) + ": must be " + kind);
    }
    return value;
  }

  const py::dict& fields_;
};

}  // namespace

py::dict dict_of(const plc_parameters& parameters) {
  plc_parameters p = parameters;
  Writer writer;
  visit(p, writer);
  return writer.take();
}

plc_parameters parameters_of(const py::dict& fields) {
  plc_parameters p;
  plc_parameters_defaults(&p);
  Reader reader(fields);
  visit(p, reader);
  return p;
}

plc_space space_of(const std::string& word) {
  return static_cast<plc_space>(value_of(
      "space", word, {{"lps", PLC_SPACE_LPS}, {"ras", PLC_SPACE_RAS}, {"voxel", PLC_SPACE_VOXEL}}));
}

plc_scalar scalar_of(const std::string& word) {
  return static_cast<plc_scalar>(value_of("scalar", word,
                                          {{"mean_curvature", PLC_SCALAR_MEAN_CURVATURE},
                                           {"gaussian_curvature", PLC_SCALAR_GAUSSIAN_CURVATURE},
                                           {"area", PLC_SCALAR_AREA},
                                           {"valence", PLC_SCALAR_VALENCE},
                                           {"movement", PLC_SCALAR_MOVEMENT}}));
}

plc_simd simd_of(const std::string& word) {
  return static_cast<plc_simd>(value_of("simd", word,
                                        {{"auto", PLC_SIMD_AUTO},
                                         {"scalar", PLC_SIMD_SCALAR},
                                         {"sse4", PLC_SIMD_SSE4},
                                         {"avx2", PLC_SIMD_AVX2},
                                         {"avx512", PLC_SIMD_AVX512}}));
}

}  // namespace plc::python
