#include "tools/python/src/parameters.h"

#include <cmath>
#include <string>
#include <vector>

namespace plc::python {

namespace {

struct Word {
  const char* word;
  int value;
};
using Words = std::vector<Word>;

int value_of(const std::string& name, const std::string& word, const Words& words) {
  std::string known;
  for (const Word& w : words) {
    if (word == w.word) return w.value;
    known += (known.empty() ? "'" : ", '") + std::string(w.word) + "'";
  }
  throw py::value_error(name + " '" + word + "': must be one of " + known);
}

// A field of a plc_parameters, by what the engine tells of it.
class Field {
 public:
  Field(plc_parameters& parameters, const plc_parameter_info& info)
      : info_(info), at_(reinterpret_cast<char*>(&parameters) + info.offset) {}

  double* reals() const { return reinterpret_cast<double*>(at_); }
  int* integers() const { return reinterpret_cast<int*>(at_); }
  // None in Python: what the engine derives from the image.
  bool derivable() const { return std::isnan(info_.value) || info_.value < 0; }
  bool derived() const {
    return derivable() && (real() ? std::isnan(*reals()) : *integers() == info_.value);
  }
  bool real() const { return info_.kind == PLC_PARAMETER_REAL; }
  std::vector<Word> words() const {
    std::vector<Word> words;
    for (int value = static_cast<int>(info_.lowest); value <= info_.highest; ++value) {
      words.push_back({info_.words[words.size()], value});
    }
    return words;
  }
  py::object one(int i) const {
    switch (info_.kind) {
      case PLC_PARAMETER_FLAG:
        return py::bool_(integers()[i] != 0);
      case PLC_PARAMETER_CHOICE:
        return py::str(info_.words[integers()[i] - static_cast<int>(info_.lowest)]);
      case PLC_PARAMETER_COUNT:
        return py::int_(integers()[i]);
      default:
        return py::float_(reals()[i]);
    }
  }
  // By the kind of the field.
  void set(const py::object& value) const {
    const std::string none = derivable() ? " or None" : "";
    if (value.is_none() && derivable()) {
      if (real()) {
        *reals() = NAN;
      } else {
        *integers() = -1;
      }
    } else if (info_.kind == PLC_PARAMETER_FLAG) {
      *integers() = cast<bool>("True or False", value) ? 1 : 0;
    } else if (info_.kind == PLC_PARAMETER_CHOICE) {
      *integers() = value_of(info_.name, cast<std::string>("a string", value), words());
    } else if (real()) {
      *reals() = cast<double>("a number" + none, value);
    } else {
      *integers() = cast<int>("an integer" + none, value);
    }
  }
  template <class T>
  T cast(const std::string& kind, const py::object& value) const {
    try {
      return value.cast<T>();
    } catch (const py::cast_error&) {
      throw py::type_error(std::string(info_.name) + ": must be " + kind + ", not " +
                           py::repr(value).cast<std::string>());
    }
  }
  py::sequence sequence(const char* kind, const py::object& value) const {
    if (!py::isinstance<py::sequence>(value) || py::isinstance<py::str>(value)) {
      throw py::type_error(std::string(info_.name) + ": must be " + kind);
    }
    return value;
  }

 private:
  const plc_parameter_info& info_;
  char* at_;
};

// Python has level_iso as one tuple, of any length.
const char* const kLevelIso = "level_iso";
const char* const kLevelIsoCount = "level_iso_count";

py::object value_in(plc_parameters& p, const plc_parameter_info& info) {
  const Field field(p, info);
  const bool isos = std::string(info.name) == kLevelIso;
  const int count = isos ? p.level_iso_count : info.count;
  if (count == 0 || field.derived()) return py::none();
  if (info.count == 1) return field.one(0);
  py::tuple all(count);
  for (int i = 0; i < count; ++i) all[static_cast<size_t>(i)] = field.one(i);
  return all;
}

void set_level_isos(plc_parameters& p, const Field& field, const py::object& value) {
  p.level_iso_count = 0;
  if (value.is_none()) return;
  const py::sequence all = field.sequence("numbers or None", value);
  if (all.size() > PLC_MAX_LEVELS) {
    throw py::value_error("level_iso: more values than there can be levels");
  }
  for (const py::handle& iso : all) {
    p.level_iso[p.level_iso_count++] =
        field.cast<double>("numbers or None", py::reinterpret_borrow<py::object>(iso));
  }
  if (p.level_iso_count == 0) throw py::value_error("level_iso: None where there are no values");
}

void set_counts(const plc_parameter_info& info, const Field& field, const py::object& value) {
  const py::sequence all = field.sequence("three integers", value);
  if (all.size() != static_cast<size_t>(info.count)) {
    throw py::value_error(std::string(info.name) + ": must be three integers");
  }
  for (size_t i = 0; i < all.size(); ++i) {
    field.integers()[i] = field.cast<int>("three integers", py::object(all[i]));
  }
}

}  // namespace

py::dict dict_of(const plc_parameters& parameters) {
  plc_parameters p = parameters;
  py::dict fields;
  for (int i = 0; const plc_parameter_info* info = plc_parameter_at(i); ++i) {
    if (std::string(info->name) != kLevelIsoCount) fields[info->name] = value_in(p, *info);
  }
  return fields;
}

plc_parameters parameters_of(const py::dict& fields) {
  plc_parameters p;
  plc_parameters_defaults(&p);
  for (int i = 0; const plc_parameter_info* info = plc_parameter_at(i); ++i) {
    if (!fields.contains(info->name)) continue;
    const Field field(p, *info);
    const py::object value = fields[info->name];
    if (std::string(info->name) == kLevelIso) {
      set_level_isos(p, field, value);
    } else if (info->count > 1) {
      set_counts(*info, field, value);
    } else {
      field.set(value);
    }
  }
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
                                         {"avx512", PLC_SIMD_AVX512},
                                         {"neon", PLC_SIMD_NEON}}));
}

}  // namespace plc::python
