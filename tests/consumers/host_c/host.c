/* A host in C: a surface out of an image in memory, level by level, saved and restored on the way.
 *
 *   host_c [OUTPUT.obj]
 */
#include <inttypes.h>
#include <math.h>
#include <pellicle.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 40 };
static const double kSpacing = 0.8; /* mm */
static const double kRing = 9.5;    /* of the torus's middle line, mm */
static const double kTube = 4.5;    /* of what is around it, mm */

static double torus_volume(void) {
  const double pi = 3.14159265358979323846;
  return 2 * pi * pi * kRing * kTube * kTube;
}

/* 100 on the middle line of a torus, 50 on its surface, falling off to 0. */
static void paint_torus(int16_t* voxels) {
  const double middle = (SIZE - 1) / 2.0;
  for (int z = 0; z < SIZE; ++z) {
    for (int y = 0; y < SIZE; ++y) {
      for (int x = 0; x < SIZE; ++x) {
        const double dx = (x - middle) * kSpacing;
        const double dy = (y - middle) * kSpacing;
        const double dz = (z - middle) * kSpacing;
        const double from_ring = hypot(hypot(dx, dy) - kRing, dz);
        *voxels++ = (int16_t)lround(fmax(0, 100 - 50 * from_ring / kTube));
      }
    }
  }
}

static void on_log(plc_log_level level, const char* line, void* user) {
  (void)user;
  printf("%s: %s\n", level == PLC_LOG_WARNING ? "warning" : "info", line);
}

/* Other than 0 would cancel the run, which could go on later. */
static int on_progress(const plc_progress* progress, void* user) {
  double* fraction = user;
  *fraction = progress->fraction;
  return 0;
}

/* What a host keeps from call to call. All of it may be destroyed in any order. */
typedef struct host {
  plc_context* context;
  plc_volume* volume;
  plc_pyramid* pyramid;
  plc_run* run;
  plc_surface* surface;
  plc_parameters parameters;
  plc_extras extras;
  double fraction;
} host;

static void destroy(host* h) {
  plc_surface_destroy(h->surface);
  plc_run_destroy(h->run);
  plc_pyramid_destroy(h->pyramid);
  plc_volume_destroy(h->volume);
  plc_context_destroy(h->context);
}

static int failed(const host* h, const char* what) {
  fprintf(stderr, "host_c: %s: %s\n", what, plc_context_message(h->context));
  return 0;
}

static int make_context(host* h) {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.log = on_log;
  char error[256] = "";
  if (plc_context_create(&options, &h->context, error, sizeof error) != PLC_OK) {
    fprintf(stderr, "host_c: %s\n", error);
    return 0;
  }
  return 1;
}

/* The voxels are borrowed: they must stay until the run is through. */
static int make_pyramid(host* h, const int16_t* voxels) {
  plc_image image;
  plc_image_defaults(&image);
  image.type = PLC_I16;
  image.voxels = voxels;
  for (int axis = 0; axis < 3; ++axis) {
    image.dims[axis] = SIZE;
    image.spacing[axis] = kSpacing;
  }
  if (plc_volume_create(h->context, &image, PLC_BORROW, &h->volume) != PLC_OK) {
    return failed(h, "volume");
  }
  plc_parameters_defaults(&h->parameters);
  h->parameters.iso = 50;
  h->parameters.levels = 2;
  h->parameters.curvature = 0.1;
  if (plc_pyramid_create(h->context, h->volume, &h->parameters, &h->pyramid) != PLC_OK) {
    return failed(h, "pyramid");
  }
  for (int level = plc_pyramid_levels(h->pyramid); level >= 0; --level) {
    plc_pyramid_level info;
    plc_pyramid_level_defaults(&info);
    if (plc_pyramid_level_info(h->context, h->pyramid, level, &info) != PLC_OK) {
      return failed(h, "level");
    }
    printf("level %d: %" PRId64 " x %" PRId64 " x %" PRId64 " voxels, iso %.1f\n", level,
           info.dims[0], info.dims[1], info.dims[2], info.iso);
  }
  return 1;
}

/* The run as bytes, and back: as if the program had ended here and had been started again. */
static int save_and_restore(host* h) {
  size_t size = 0;
  if (plc_run_save(h->context, h->run, NULL, 0, &size) != PLC_OK) return failed(h, "save");
  void* state = malloc(size);
  if (state == NULL) {
    fprintf(stderr, "host_c: out of memory\n");
    return 0;
  }
  plc_status status = plc_run_save(h->context, h->run, state, size, &size);
  if (status == PLC_OK) {
    plc_run_destroy(h->run);
    status = plc_run_restore(h->context, h->pyramid, &h->parameters, &h->extras, state, size,
                             &h->run); /* NULL where it fails */
  }
  free(state);
  if (status != PLC_OK) return failed(h, "save and restore");
  printf("saved and restored: %zu bytes\n", size);
  return 1;
}

static int evolve(host* h) {
  plc_extras_defaults(&h->extras);
  h->extras.progress = on_progress;
  h->extras.progress_user = &h->fraction;
  if (plc_run_create(h->context, h->pyramid, &h->parameters, &h->extras, &h->run) != PLC_OK) {
    return failed(h, "run");
  }
  plc_run_state state;
  plc_run_state_defaults(&state);
  for (int levels = 1; !state.done; ++levels) {
    if (plc_run_advance(h->context, h->run, PLC_ONE_LEVEL, &state) != PLC_OK) {
      return failed(h, "evolution");
    }
    printf("level %d done: %d iterations, %" PRId64 " vertices, %.0f %%\n", state.progress.level,
           state.progress.iteration, state.progress.vertices, 100 * h->fraction);
    if (levels == 1 && !save_and_restore(h)) return 0;
  }
  if (plc_run_surface(h->context, h->run, &h->surface) != PLC_OK) return failed(h, "surface");
  return 1;
}

/* A valid torus of the volume that was painted. */
static int verify(const host* h) {
  plc_check check;
  plc_check_defaults(&check);
  if (plc_surface_check(h->context, h->surface, &check) != PLC_OK) return failed(h, "check");
  const plc_measures* m = &check.measures;
  printf("%" PRId64 " vertices, %" PRId64 " faces, genus %" PRId64
         ", %.1f mm2, %.1f mm3 "
         "(painted: %.1f mm3)\n",
         m->vertices, m->faces, m->genus, m->area, m->volume, torus_volume());
  if (!plc_surface_converged(h->surface)) {
    fprintf(stderr, "host_c: the surface has not come to rest: more iterations?\n");
    return 0;
  }
  if (!check.valid || m->components != 1 || m->genus != 1 ||
      fabs(m->volume / torus_volume() - 1) > 0.1) {
    fprintf(stderr, "host_c: the surface is not the torus\n");
    return 0;
  }
  return 1;
}

static int write_obj(const host* h, const char* path) {
  const int64_t vertices = plc_surface_vertex_count(h->surface);
  const int64_t faces = plc_surface_face_count(h->surface);
  float* xyz = malloc(3 * (size_t)vertices * sizeof *xyz);
  uint32_t* abc = malloc(3 * (size_t)faces * sizeof *abc);
  FILE* file = NULL;
  int good = 0;
  if (xyz == NULL || abc == NULL) {
    fprintf(stderr, "host_c: out of memory\n");
  } else if (plc_surface_positions(h->context, h->surface, PLC_SPACE_LPS, xyz, vertices) !=
                 PLC_OK ||
             plc_surface_faces(h->context, h->surface, PLC_SPACE_LPS, abc, faces) != PLC_OK) {
    failed(h, "vertices and faces");
  } else if ((file = fopen(path, "w")) == NULL) {
    perror(path);
  } else {
    for (int64_t i = 0; i < vertices; ++i) {
      fprintf(file, "v %.9g %.9g %.9g\n", xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
    }
    for (int64_t i = 0; i < faces; ++i) {
      fprintf(file, "f %" PRIu32 " %" PRIu32 " %" PRIu32 "\n", abc[3 * i] + 1, abc[3 * i + 1] + 1,
              abc[3 * i + 2] + 1);
    }
    good = ferror(file) == 0;
    good = fclose(file) == 0 && good;
    if (!good) perror(path);
  }
  free(xyz);
  free(abc);
  return good;
}

int main(int argc, char** argv) {
  if (plc_version() < PLC_VERSION) {
    fprintf(stderr, "host_c: needs libpellicle %d.%d.%d, found %s\n", PLC_VERSION_MAJOR,
            PLC_VERSION_MINOR, PLC_VERSION_PATCH, plc_version_string());
    return EXIT_FAILURE;
  }
  static int16_t voxels[SIZE * SIZE * SIZE];
  paint_torus(voxels);
  host h;
  memset(&h, 0, sizeof h);
  const int good = make_context(&h) && make_pyramid(&h, voxels) && evolve(&h) && verify(&h) &&
                   (argc < 2 || write_obj(&h, argv[1]));
  destroy(&h);
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
