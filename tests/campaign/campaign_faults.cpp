#include "tests/campaign/campaign_faults.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/campaign/campaign_start.h"

namespace campaign {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Fault {
  const char* name;
  plc_status status;
  const char* phrase;  // of the message
  void (*spoil)(Case& c);
};

void put_float(Case& c, float value) {
  c.image.type = PLC_F32;
  c.voxels.resize(static_cast<size_t>(c.image.dims[0] * c.image.dims[1] * c.image.dims[2]) *
                  sizeof value);
  c.image.voxels = c.voxels.data();
  // The rest is what bytes of another type happen to mean: the bad voxel is found before.
  for (size_t at = 0; at < c.voxels.size(); at += sizeof value) {
    const float fine = static_cast<float>(at % 7);
    std::memcpy(c.voxels.data() + at, &fine, sizeof fine);
  }
  std::memcpy(c.voxels.data() + c.voxels.size() / 8 * 4, &value, sizeof value);
  c.parameters.feature = PLC_FEATURE_NONE;
}

void set_seeds(Case& c, const plc_seed& seed) {
  c.parameters.init = PLC_INIT_SEEDS;
  c.seeds.assign(1, seed);
}

void set_mesh(Case& c, const samples::Soup& voxels) {
  c.parameters.init = PLC_INIT_MESH;
  c.mesh = in_space(c, voxels);
}

void set_mask(Case& c) {
  c.parameters.init = PLC_INIT_MASK;
  plc_image_defaults(&c.mask);
  c.mask.type = PLC_U8;
  std::copy_n(c.image.dims, 3, c.mask.dims);
  c.mask_voxels.assign(static_cast<size_t>(c.mask.dims[0] * c.mask.dims[1] * c.mask.dims[2]),
                       std::byte{1});
  c.mask.voxels = c.mask_voxels.data();
}

samples::Soup ball() {
  return ellipsoid({6, 6, 6}, {4, 4, 4}, 2);
}

// A value of the enumeration's bits that has no name.
template <typename E>
E nameless(int value) {
  return static_cast<E>(value);
}

constexpr plc_status kArgument = PLC_INVALID_ARGUMENT;
constexpr plc_status kData = PLC_INVALID_DATA;

const Fault kFaults[] = {
    {"NaN voxel", kData, "NaN or infinite", [](Case& c) { put_float(c, std::nanf("")); }},
    {"infinite voxel", kData, "NaN or infinite",
     [](Case& c) { put_float(c, -std::numeric_limits<float>::infinity()); }},
    {"constant image", kData, "constant image",
     [](Case& c) {
       std::fill(c.voxels.begin(), c.voxels.end(), std::byte{0});
       c.parameters.feature = PLC_FEATURE_NONE;
     }},
    {"iso below the range", kArgument, "iso ", [](Case& c) { c.parameters.iso = -1e12; }},
    {"iso above the range", kArgument, "iso ", [](Case& c) { c.parameters.iso = 1e12; }},
    {"iso infinite", kArgument, "iso ", [](Case& c) { c.parameters.iso = kInfinity; }},
    {"iso not set", kArgument, "iso: not set",
     [](Case& c) {
       c.parameters.iso = kNan;
       c.parameters.force = PLC_FORCE_ISO;
     }},
    {"reduction 1", kArgument, "reduction ", [](Case& c) { c.parameters.reduction = 1; }},
    {"reduction 2.5", kArgument, "reduction ", [](Case& c) { c.parameters.reduction = 2.5; }},
    {"reduction NaN", kArgument, "reduction ", [](Case& c) { c.parameters.reduction = kNan; }},
    {"too many levels", kArgument, "levels ",
     [](Case& c) {
       c.parameters.levels = 31;
       c.parameters.level_iso_count = 0;
     }},
    {"levels 32", kArgument, "levels ", [](Case& c) { c.parameters.levels = 32; }},
    {"levels -2", kArgument, "levels ", [](Case& c) { c.parameters.levels = -2; }},
    {"values of too few levels", kArgument, "level iso-values",
     [](Case& c) {
       c.parameters.levels = 1;
       c.parameters.level_iso_count = 1;
       if (std::isnan(c.parameters.iso)) c.parameters.force = PLC_FORCE_GRADIENT;
     }},
    {"window reversed", kArgument, "window ",
     [](Case& c) {
       c.parameters.window_low = 1e12;
       c.parameters.window_high = -1e12;
     }},
    {"window infinite", kArgument, "window ",
     [](Case& c) { c.parameters.window_low = -kInfinity; }},
    {"pad value infinite", kArgument, "pad value ",
     [](Case& c) { c.parameters.pad_value = kInfinity; }},
    {"spacing 0", kData, "spacing ", [](Case& c) { c.image.spacing[1] = 0; }},
    {"spacing NaN", kData, "spacing ", [](Case& c) { c.image.spacing[2] = kNan; }},
    {"origin NaN", kData, "origin", [](Case& c) { c.image.origin[0] = kNan; }},
    {"axes in a plane", kData, "direction",
     [](Case& c) {
       for (size_t i = 0; i < 3; ++i) c.image.direction[3 * i] = c.image.direction[3 * i + 1];
     }},
    {"a slice", kData, "at least 2", [](Case& c) { c.image.dims[0] = 1; }},
    {"negative size", kData, "at least 2", [](Case& c) { c.image.dims[2] = -5; }},
    {"no voxels", kArgument, "no voxels", [](Case& c) { c.image.voxels = nullptr; }},
    {"image of a later version", kArgument, "struct_size",
     [](Case& c) { c.image.struct_size += 8; }},
    {"voxel type 7", kArgument, "plc_voxel_type",
     [](Case& c) { c.image.type = nameless<plc_voxel_type>(7); }},
    {"curvature -1", kArgument, "curvature ", [](Case& c) { c.parameters.curvature = -1; }},
    {"spring NaN", kArgument, "spring ", [](Case& c) { c.parameters.spring = kNan; }},
    {"attraction 0", kArgument, "attraction ", [](Case& c) { c.parameters.attraction = 0; }},
    {"mass 0", kArgument, "mass ", [](Case& c) { c.parameters.mass = 0; }},
    {"damping -1", kArgument, "damping ", [](Case& c) { c.parameters.damping = -1; }},
    {"time step NaN", kArgument, "time step ", [](Case& c) { c.parameters.time_step = kNan; }},
    {"max move 2", kArgument, "max move ", [](Case& c) { c.parameters.max_move = 2; }},
    {"epsilon 0", kArgument, "epsilon ", [](Case& c) { c.parameters.epsilon = 0; }},
    {"no iterations", kArgument, "max iterations ",
     [](Case& c) { c.parameters.max_iterations = 0; }},
    {"anisotropy 0", kArgument, "anisotropy ",
     [](Case& c) { c.parameters.anisotropy = nameless<plc_anisotropy>(0); }},
    {"init 7", kArgument, "init ", [](Case& c) { c.parameters.init = nameless<plc_init>(7); }},
    {"sleeping 2", kArgument, "sleeping ", [](Case& c) { c.parameters.sleeping = 2; }},
    {"bubbles 0", kArgument, "bubbles ", [](Case& c) { c.parameters.bubbles[1] = 0; }},
    {"256 bubbles a side", kArgument, "bubbles ",
     [](Case& c) {
       c.parameters.init = PLC_INIT_BUBBLES;
       for (int& n : c.parameters.bubbles) n = 256;
     }},
    {"no seeds", kArgument, "seeds: none",
     [](Case& c) {
       c.parameters.init = PLC_INIT_SEEDS;
       c.without_seeds = true;
     }},
    {"seed of no radius", kArgument, "seed 0",
     [](Case& c) {
       set_seeds(c, {{0, 0, 0}, 0});
     }},
    {"seed nowhere", kArgument, "seed 0",
     [](Case& c) {
       set_seeds(c, {{0, kNan, 0}, 5});
     }},
    {"negative count of seeds", kArgument, "seeds: a negative count",
     [](Case& c) { c.bad_count = true; }},
    {"no mask", kArgument, "mask: none",
     [](Case& c) {
       c.parameters.init = PLC_INIT_MASK;
       c.without_mask = true;
     }},
    {"mask of another size", kArgument, "mask of ",
     [](Case& c) {
       set_mask(c);
       --c.mask.dims[0];
     }},
    {"empty mask", kData, "mask: every voxel is 0",
     [](Case& c) {
       set_mask(c);
       std::fill(c.mask_voxels.begin(), c.mask_voxels.end(), std::byte{0});
     }},
    {"no mesh", kArgument, "mesh: none",
     [](Case& c) {
       c.parameters.init = PLC_INIT_MESH;
       c.without_mesh = true;
     }},
    {"open mesh", kData, "open",
     [](Case& c) {
       samples::Soup m = ball();
       m.abc.resize(m.abc.size() - 3);
       set_mesh(c, m);
     }},
    {"mesh with a face turned", kData, "oriented",
     [](Case& c) {
       samples::Soup m = ball();
       std::swap(m.abc[0], m.abc[1]);
       set_mesh(c, m);
     }},
    {"mesh inside out", kData, "wrongly oriented",
     [](Case& c) { set_mesh(c, samples::flipped(ball())); }},
    {"meshes that meet", kData, "self-intersecting",
     [](Case& c) {
       samples::Soup m = ball();
       m.append(samples::moved(ball(), 2, 1, 0.5));
       set_mesh(c, m);
     }},
    {"mesh with a NaN", kData, "finite",
     [](Case& c) {
       set_mesh(c, ball());
       c.mesh.xyz[4] = kNan;
     }},
    {"mesh with a vertex too many", kData, "vertex",
     [](Case& c) {
       set_mesh(c, ball());
       c.mesh.abc[5] = static_cast<uint32_t>(c.mesh.vertex_count());
     }},
    {"pin of no radius", kArgument, "pin 0",
     [](Case& c) {
       c.pins.insert(c.pins.begin(), plc_pin{{0, 0, 0}, 0});
     }},
    {"attachment that repels", kArgument, "attachment 0",
     [](Case& c) {
       c.attachments.insert(c.attachments.begin(), plc_attachment{{0, 0, 0}, 3, -1});
     }},
    {"space 3", kArgument, "plc_space", [](Case& c) { c.space = nameless<plc_space>(3); }},
    {"force that is not finite", kArgument, "force callback",
     [](Case& c) { c.force = UserForce::kNotFinite; }},
};

}  // namespace

void choose_fault(Case& c, Random& random) {
  const Fault& fault = random.one_of(kFaults);
  c.fault = fault.name;
  c.refusals.push_back({fault.status, fault.phrase});
  fault.spoil(c);
}

}  // namespace campaign
