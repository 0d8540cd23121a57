/* What engine.mjs calls: one extraction at a time, in numbers and pointers of WebAssembly's memory.
 */
#include <stdlib.h>
#include <string.h>

#include "engine/pellicle.h"

#define EXPORT(name) __attribute__((export_name(#name))) name
#define IMPORT(name) __attribute__((import_module("pellicle"), import_name(#name)))

/* Called after every iteration. */
IMPORT(progress)
extern void js_progress(int level, int levels, int iteration, double vertices, double fraction,
                        double seconds);
/* A line without its end. */
IMPORT(log) extern void js_log(int level, const char* line);

static plc_context* context;
static plc_parameters parameters;
static plc_image image;
static plc_run* run;
static plc_run_state run_state;
static plc_surface* surface;
static char message[1024];

static void log_line(plc_log_level level, const char* line, void* user) {
  (void)user;
  js_log((int)level, line);
}

static int told(plc_status status) {
  strncpy(message, plc_context_message(context), sizeof message - 1);
  return (int)status;
}

static int on_progress(const plc_progress* p, void* user) {
  (void)user;
  js_progress(p->level, p->levels, p->iteration, (double)p->vertices, p->fraction, p->seconds);
  return 0;
}

/* Before all else; a plc_status. */
int EXPORT(start)(void) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.threads = 1;
  options.log = log_line;
  plc_parameters_defaults(&parameters);
  plc_image_defaults(&image);
  return (int)plc_context_create(&options, &context, message, sizeof message);
}

void* EXPORT(allocate)(double bytes) {
  return bytes < 4294967296.0 ? malloc((size_t)bytes) : NULL;
}
void EXPORT(release)(void* data) {
  free(data);
}

const char* EXPORT(last_message)(void) {
  return message;
}
const char* EXPORT(simd)(void) {
  return plc_context_simd(context);
}
const char* EXPORT(version)(void) {
  return plc_version_string();
}

/* Value `index` of a parameter. 0: done; 1: no such parameter; 2: no such index. */
int EXPORT(set_parameter)(const char* name, int index, double value) {
  const plc_parameter_info* info;
  for (int i = 0; (info = plc_parameter_at(i)) != NULL; ++i) {
    if (strcmp(info->name, name) != 0) continue;
    if (index < 0 || index >= info->count) return 2;
    char* field = (char*)&parameters + info->offset;
    if (info->kind == PLC_PARAMETER_REAL) {
      ((double*)field)[index] = value;
    } else {
      ((int*)field)[index] = (int)value;
    }
    return 0;
  }
  return 1;
}
/* The same by the word of a choice; 3: no such word. */
int EXPORT(choose_parameter)(const char* name, const char* word) {
  const plc_parameter_info* info;
  for (int i = 0; (info = plc_parameter_at(i)) != NULL; ++i) {
    if (strcmp(info->name, name) != 0) continue;
    if (info->words == NULL) return 3;
    for (int k = 0; k <= (int)(info->highest - info->lowest); ++k) {
      if (strcmp(info->words[k], word) != 0) continue;
      return set_parameter(name, 0, info->lowest + k);
    }
    return 3;
  }
  return 1;
}

/* Before extract or run_start. geometry: spacing, origin and direction of plc_image, 15 doubles. */
void EXPORT(set_image)(int type, const void* voxels, int width, int height, int depth,
                       const double* geometry) {
  image.type = (plc_voxel_type)type;
  image.voxels = voxels;
  image.dims[0] = width;
  image.dims[1] = height;
  image.dims[2] = depth;
  memcpy(image.spacing, geometry, sizeof image.spacing);
  memcpy(image.origin, geometry + 3, sizeof image.origin);
  memcpy(image.direction, geometry + 6, sizeof image.direction);
}

static plc_extras listening(void) {
  plc_extras extras;
  plc_extras_defaults(&extras);
  extras.progress = on_progress;
  return extras;
}

int EXPORT(extract)(void) {
  const plc_extras extras = listening();
  return told(plc_extract(context, &image, &parameters, &extras, &surface));
}

/* The same in iterations, with more memory: run_start, then run_advance until run_done. Between any
 * two, and at the end, take_surface makes the surface as it is what is asked for below. */
int EXPORT(run_start)(void) {
  const plc_extras extras = listening();
  plc_volume* volume = NULL;
  plc_pyramid* pyramid = NULL;
  int status = told(plc_volume_create(context, &image, PLC_BORROW, &volume));
  if (status == PLC_OK) status = told(plc_pyramid_create(context, volume, &parameters, &pyramid));
  if (status == PLC_OK) status = told(plc_run_create(context, pyramid, &parameters, &extras, &run));
  plc_pyramid_destroy(pyramid);
  plc_volume_destroy(volume);
  plc_run_state_defaults(&run_state);
  return status;
}
int EXPORT(run_advance)(void) {
  return told(plc_run_advance(context, run, PLC_ONE_ITERATION, &run_state));
}
int EXPORT(run_done)(void) {
  return run_state.done;
}
int EXPORT(take_surface)(void) {
  plc_surface_destroy(surface);
  surface = NULL;
  return told(plc_run_surface(context, run, &surface));
}

double EXPORT(vertex_count)(void) {
  return (double)plc_surface_vertex_count(surface);
}
double EXPORT(face_count)(void) {
  return (double)plc_surface_face_count(surface);
}
int EXPORT(converged)(void) {
  return plc_surface_converged(surface);
}
/* values: components, Euler's number, genus, area, volume. */
int EXPORT(measure)(int space, double* values) {
  plc_measures measures;
  plc_measures_defaults(&measures);
  const int status = told(plc_surface_measure(context, surface, (plc_space)space, &measures));
  values[0] = (double)measures.components;
  values[1] = (double)measures.euler;
  values[2] = (double)measures.genus;
  values[3] = measures.area;
  values[4] = measures.volume;
  return status;
}
unsigned EXPORT(hash_high)(void) {
  return (unsigned)(plc_surface_hash(surface) >> 32);
}
unsigned EXPORT(hash_low)(void) {
  return (unsigned)plc_surface_hash(surface);
}

int EXPORT(positions)(int space, float* xyz) {
  return told(plc_surface_positions(context, surface, (plc_space)space, xyz,
                                    plc_surface_vertex_count(surface)));
}
int EXPORT(normals)(int space, float* xyz) {
  return told(plc_surface_normals(context, surface, (plc_space)space, xyz,
                                  plc_surface_vertex_count(surface)));
}
int EXPORT(faces)(int space, uint32_t* abc) {
  return told(
      plc_surface_faces(context, surface, (plc_space)space, abc, plc_surface_face_count(surface)));
}
