/* Pellicle: closed, oriented, non-self-intersecting triangulated surfaces from 3D images.
 *
 * The C API of the engine; pellicle.hpp is a layer for C++ on it. It implements Lachaud &
 * Montanvert, "Deformable Meshes with Automated Topology Changes for Coarse-to-fine 3D Surface
 * Extraction"; numbers in parentheses are its equations, section numbers are its sections.
 *
 *   plc_extract                                            an image to a surface, in one call
 *   plc_volume_create, plc_pyramid_create, plc_run_create  the same in steps of any size
 *   plc_volume_create_bricks                               an image that memory does not hold
 *
 * Errors: every function that can fail returns a plc_status; plc_context_message() then says in
 * one line what was wrong. No function exits, prints, throws, or changes the locale or signals. All
 * compute, and make callbacks, in the default floating-point environment, and leave the caller's as
 * it was. NULL where it must not be is PLC_INVALID_ARGUMENT. After a
 * failed call its outputs are unchanged or, where they are handles, NULL; every handle can still be
 * used or destroyed.
 *
 * Threads: a context, and what was made with it, may be used by one thread at a time; different
 * contexts are independent and share nothing. Callbacks are made on the thread that called, but
 * for those of plc_context_options and plc_bricks, which say so. A callback may use any handle but
 * a run that is in the middle of a call. It must not destroy the context of the call or the
 * handles that were given to it, nor leave it by an exception or longjmp. Callbacks can stop what
 * evolves a surface; making volumes, pyramids, runs and surfaces, and checking and measuring,
 * cannot be stopped.
 *
 * Structs start with struct_size: fill them with their _defaults function, then change fields. Of
 * structs that are only written it sets struct_size = sizeof, and all else to 0. A library newer
 * than the header that a host was built with takes what it does not get at its default; one that is
 * older refuses the struct with PLC_INVALID_ARGUMENT. Structs within others and in arrays will not
 * grow: plc_measures, plc_progress, plc_component_measures, plc_seed, plc_attachment, plc_pin.
 *
 * Handles are freed with their _destroy function, which takes NULL, in any order: what a handle
 * needs of others it keeps alive. What a host lends - voxels, allocator, threads, log - must
 * outlive the handles that use it.
 *
 * Results are the same bits for any number of threads, any SIMD target and any allocator.
 */
#ifndef PLC_PELLICLE_H
#define PLC_PELLICLE_H

#include <stddef.h>
#include <stdint.h>

#define PLC_VERSION_MAJOR 0
#define PLC_VERSION_MINOR 3
#define PLC_VERSION_PATCH 0
/* Comparable: later versions are larger. Below 1.0 hosts are to be built with the MAJOR.MINOR that
 * they run with; 0.3 turned level_iso of plc_parameters round. */
#define PLC_VERSION (PLC_VERSION_MAJOR * 1000000 + PLC_VERSION_MINOR * 1000 + PLC_VERSION_PATCH)

/* Windows: a host that links the static library defines PLC_STATIC. */
#if defined(_WIN32) && defined(PLC_BUILDS_LIBRARY)
#define PLC_API __declspec(dllexport)
#elif defined(_WIN32) && !defined(PLC_STATIC)
#define PLC_API __declspec(dllimport)
#elif defined(_WIN32)
#define PLC_API
#else
#define PLC_API __attribute__((visibility("default")))
#endif

/* Enumerations are ints, in C++ too: any value may be passed. Where it is none of the enumeration's
 * it is refused, or treated as is said there. */
#ifdef __cplusplus
#define PLC_INT : int
extern "C" {
#else
#define PLC_INT
#endif

typedef enum plc_status PLC_INT {
  PLC_OK = 0,
  PLC_INVALID_ARGUMENT = 1, /* a parameter is outside its range */
  PLC_INVALID_DATA = 2,     /* the image or mesh cannot be used */
  PLC_OUT_OF_MEMORY = 3,    /* the message tells how much was asked for, but for small things */
  PLC_CANCELLED = 4,        /* a callback asked to stop */
  PLC_INTERNAL = 5 /* a bug of the engine, caught before it did harm; the message tells the cause */
} plc_status;

typedef enum plc_simd PLC_INT {
  PLC_SIMD_AUTO = 0, /* the best of this machine */
  PLC_SIMD_SCALAR = 1,
  PLC_SIMD_SSE4 = 2,
  PLC_SIMD_AVX2 = 3,
  PLC_SIMD_AVX512 = 4,
  PLC_SIMD_NEON = 5,
  PLC_SIMD_WASM = 6 /* WebAssembly's 128 bits */
} plc_simd;

typedef enum plc_voxel_type PLC_INT {
  PLC_U8 = 0,
  PLC_I16 = 1,
  PLC_U16 = 2,
  PLC_I32 = 3,
  PLC_F32 = 4
} plc_voxel_type;

typedef enum plc_space PLC_INT {
  PLC_SPACE_LPS = 0,  /* patient space, mm, x to the left, y to the back, z to the head (as ITK) */
  PLC_SPACE_RAS = 1,  /* patient space, mm, x to the right, y to the front, z to the head */
  PLC_SPACE_VOXEL = 2 /* voxel indices of the input image, voxel centres at integers */
} plc_space;

typedef struct plc_context plc_context;
typedef struct plc_volume plc_volume;
typedef struct plc_pyramid plc_pyramid;
typedef struct plc_run plc_run;
typedef struct plc_surface plc_surface;

/* Of the library that is running, which may be another than that of this header:
 * "MAJOR.MINOR.PATCH", static storage, and as PLC_VERSION. */
PLC_API const char* plc_version_string(void);
PLC_API int plc_version(void);
/* What a status means, in a few words without an end; for any value. Static storage. What was wrong
 * with a call is told by plc_context_message(). */
PLC_API const char* plc_status_string(plc_status status);

/* ---- context ---------------------------------------------------------------------------- */

/* One task of a parallel loop: returns when it is done, never fails. */
typedef void (*plc_task_fn)(size_t task, void* data);
/* The host's threads: calls task(0, data) .. task(tasks - 1, data), each once, in any order, on any
 * threads, the calling one included, and returns when all have returned. Not called by a task. */
typedef void (*plc_parallel_for_fn)(size_t tasks, plc_task_fn task, void* data, void* user);

/* The host's memory, called on any thread at any time. allocate: NULL where there is none;
 * alignment is a power of two, 8 .. 4096. release: what allocate has given, size and alignment as
 * they were. */
typedef void* (*plc_allocate_fn)(size_t size, size_t alignment, void* user);
typedef void (*plc_release_fn)(void* data, size_t size, size_t alignment, void* user);

typedef enum plc_log_level PLC_INT {
  PLC_LOG_WARNING = 1, /* the result is valid, and perhaps not what was wanted */
  PLC_LOG_INFO = 2     /* what the engine has derived, and how it gets on, level by level */
} plc_log_level;
/* A line without its end; valid during the call. On the thread that called the engine. */
typedef void (*plc_log_fn)(plc_log_level level, const char* line, void* user);

typedef struct plc_context_options {
  size_t struct_size;
  int threads;   /* 1 .. 1024: at most so many, and no more than oneTBB has for the process (one per
                    core, unless the host says otherwise); 1 starts none; 0: those of the caller's
                    oneTBB arena. 1 where the library has been built without oneTBB. They stay awake
                    between loops, up to 1 ms after the last.   Ignored with parallel_for */
  plc_simd simd; /* must be available on this machine */
  plc_parallel_for_fn parallel_for; /* NULL: oneTBB */
  void* parallel_for_user;
  plc_allocate_fn allocate; /* images, vertices and all else that grows with them; NULL: mimalloc
                               where the system has it, else the C library. Never the host's malloc
                               replaced. Small and fixed-size objects come from operator new */
  plc_release_fn release;   /* NULL just where allocate is */
  void* allocator_user;
  int64_t memory_limit; /* of what allocate has given at a time, bytes; 0: none. A call that would
                           go beyond fails with PLC_OUT_OF_MEMORY */
  plc_log_fn log;       /* NULL: nobody listens */
  void* log_user;
} plc_context_options;

/* All threads, the best SIMD target, no hooks, no limit. */
PLC_API void plc_context_options_defaults(plc_context_options* options);
/* options may be NULL (defaults). On failure *context is NULL and, where error is not NULL, a line
 * of at most error_size - 1 characters is written to it. */
PLC_API plc_status plc_context_create(const plc_context_options* options, plc_context** context,
                                      char* error, size_t error_size);
PLC_API void plc_context_destroy(plc_context* context);
/* What was wrong with the last call on this context; "" where it succeeded, when there was none,
 * and for NULL. Valid until the next call on the context. */
PLC_API const char* plc_context_message(const plc_context* context);
/* The number of threads that loops may run on (0 with parallel_for: the host knows) and the SIMD
 * target in use ("scalar", "sse4", "avx2", "avx512", "neon", "wasm"). 0 and "" for NULL. */
PLC_API int plc_context_threads(const plc_context* context);
PLC_API const char* plc_context_simd(const plc_context* context);
/* Bytes that are allocated now, and the most there have been, by this context and what was made
 * with it; allocator or not. Both may be NULL. */
PLC_API plc_status plc_context_memory(const plc_context* context, int64_t* now, int64_t* peak);

/* ---- images ----------------------------------------------------------------------------- */

/* An image in memory; borrowed for the duration of a call. */
typedef struct plc_image {
  size_t struct_size;
  plc_voxel_type type;
  const void* voxels; /* dims[0] * dims[1] * dims[2] values, aligned as their type */
  int64_t dims[3];    /* each >= 2 */
  int64_t strides[3]; /* bytes from a voxel to the next one on each axis, multiples of its size, may
                         be negative, leave gaps, or be 0 on some axes, along which values then
                         repeat; all 0: x fastest, no gaps */
  double spacing[3];  /* mm between voxel centres, 1e-30 .. 1e30 */
  double origin[3];   /* LPS position of the centre of voxel (0,0,0), mm, at most 1e30 */
  double direction[9]; /* row-major, columns are the axes of the image in LPS (as ITK): of length 1
                          within 1 %, not in a plane; sheared ones are fine, seeds lean with them */
} plc_image;

/* Spacing 1, origin 0, identity direction, no gaps, no voxels. */
PLC_API void plc_image_defaults(plc_image* image);

/* Whether a volume has voxels of its own, or refers to the caller's, which must then neither change
 * nor go while the volume, a pyramid or a run of it is there. */
typedef enum plc_ownership PLC_INT { PLC_COPY = 0, PLC_BORROW = 1 } plc_ownership;

/* PLC_INVALID_DATA: dims below 2 or of 2^62 bytes or more, spacing, origin or direction out of
 * range. NaN voxels are told by plc_pyramid_create. Voxels are borrowed where x is fastest and
 * there are no gaps, whether strides say so or are 0; with any others PLC_BORROW copies. */
PLC_API plc_status plc_volume_create(plc_context* context, const plc_image* image,
                                     plc_ownership ownership, plc_volume** volume);
PLC_API void plc_volume_destroy(plc_volume* volume);
/* Smallest and largest voxel; PLC_INVALID_DATA where some are NaN or infinite. */
PLC_API plc_status plc_volume_range(plc_context* context, const plc_volume* volume, double* low,
                                    double* high);
/* The image as the volume holds it: voxels live as long as the volume, strides are 0. Of bricks
 * voxels is NULL. */
PLC_API plc_status plc_volume_image(plc_context* context, const plc_volume* volume,
                                    plc_image* image);

/* ---- images larger than memory ---------------------------------------------------------- */

/* Fetches a brick: voxels[(z * brick[1] + y) * brick[0] + x], in the type of plc_bricks, is the
 * voxel (at[0] * brick[0] + x, at[1] * brick[1] + y, at[2] * brick[2] + z) of the image; those
 * beyond the image need not be written. Called on any thread of the context, on several at a time,
 * never twice at a time for the same brick, and again for bricks that were dropped since: it must
 * then give the same. It must not use handles of the context. Returns 0, or anything else where the
 * brick cannot be had: the call that needed it then fails with PLC_INVALID_DATA and `message`, one
 * line, of which there is room for `size` bytes. */
typedef int (*plc_brick_fn)(const int64_t at[3], void* voxels, char* message, size_t size,
                            void* user);

/* An image by bricks. Its fetch and user must outlive the volume and what is made of it. */
typedef struct plc_bricks {
  size_t struct_size;
  plc_voxel_type type; /* not PLC_I32 */
  int64_t dims[3];     /* voxels, each >= 2 */
  int64_t brick[3];    /* voxels of a brick; 16 .. 4096 on every axis, 2^26 in all: 32 to
                          128 on every axis are best */
  double spacing[3];   /* these three as in plc_image */
  double origin[3];
  double direction[9];
  plc_brick_fn fetch;
  void* user;
  int64_t cache; /* bytes that bricks may take; 0: half of the context's memory_limit, or 1 GiB
                    where that is 0 */
  double low;    /* the smallest and largest voxel where the host knows them, none is NaN or */
  double high;   /* infinite then; NAN: all are read for it. With window, pad value and level_iso
                    given, too, no brick is read before something needs it */
} plc_bricks;
/* Spacing 1, origin 0, identity direction, bricks of 64 voxels, no dims, nothing to fetch, a range
 * that is not known. */
PLC_API void plc_bricks_defaults(plc_bricks* bricks);

/* A volume of which only some bricks are in memory, those that were read lately. A pyramid reads
 * all of them some times in order, a run those near the surface and, where it looks for late
 * bubbles, all again; bricks of one value take no memory. Levels above I_0 that do not fit into
 * `cache` together are made by bricks, too. The same bits as of the image in memory.
 *
 * Where the context has a memory_limit, bricks make room for everything else, but for a layer of
 * them and a quarter: PLC_OUT_OF_MEMORY where those would take more than half of the limit. Not of
 * such volumes: PLC_FEATURE_GRADIENT_NORM. PLC_INVALID_DATA as plc_volume_create. */
PLC_API plc_status plc_volume_create_bricks(plc_context* context, const plc_bricks* bricks,
                                            plc_volume** volume);

typedef struct plc_brick_counts {
  size_t struct_size;
  int64_t bricks;     /* of the image */
  int64_t read;       /* how many were fetched */
  int64_t read_again; /* of them, those that had been fetched before */
} plc_brick_counts;
PLC_API void plc_brick_counts_defaults(plc_brick_counts* counts);
/* PLC_INVALID_ARGUMENT where it is no volume of bricks. struct_size must be set. */
PLC_API plc_status plc_volume_brick_counts(plc_context* context, const plc_volume* volume,
                                           plc_brick_counts* counts);

/* ---- parameters ------------------------------------------------------------------------- */

typedef enum plc_rest_length PLC_INT {
  PLC_REST_ZERO = 0, /* minimise the area (membrane) */
  PLC_REST_MEAN = 1, /* the mean edge length of the mesh at each step */
  PLC_REST_VALUE = 2 /* rest_length_value */
} plc_rest_length;

/* The surface that the evolution starts from (3.6), on the coarsest level. */
typedef enum plc_init PLC_INT {
  PLC_INIT_BUBBLE = 0,  /* one bubble around the object; around the image where iso is NAN */
  PLC_INIT_BUBBLES = 1, /* bubbles[0] x bubbles[1] x bubbles[2] bubbles over the image */
  PLC_INIT_SEEDS = 2,   /* the spheres of plc_extras */
  PLC_INIT_ISO = 3,     /* the iso-surface of the coarsest image, closed at the border (figure 23);
                           of an adaptive mesh without cavities of fewer than 27 voxels, and parts
                           of which no 27 are joined by faces; those get no late bubbles either */
  PLC_INIT_MASK = 4,    /* the surface of the mask of plc_extras, reduced like the image */
  PLC_INIT_MESH = 5,    /* the mesh of plc_extras, brought to satisfy (1)-(3) */
  PLC_INIT_AUTO = 6     /* PLC_INIT_ISO on I_0, where the mesh is adaptive, levels is 0 or, by
                           itself, becomes that, and there are no attachments and pins; else
                           PLC_INIT_BUBBLE, with those on I_0 alone, which takes long: ask for it;
                           the surface's parameters tell which */
} plc_init;

/* Which forces of the image act (3.8). */
typedef enum plc_force PLC_INT {
  PLC_FORCE_ISO = 1,      /* (7): towards the value iso */
  PLC_FORCE_GRADIENT = 2, /* (8): along the gradient; iso may be NAN */
  PLC_FORCE_BOTH = 3
} plc_force;

/* What the evolution takes for the image; iso, window and pad are values of it. */
typedef enum plc_feature PLC_INT {
  PLC_FEATURE_NONE = 0,         /* the image itself */
  PLC_FEATURE_GRADIENT_NORM = 1 /* the norm of its gradient, per mm, after a Gaussian (3.8) */
} plc_feature;

typedef enum plc_bound PLC_INT {
  PLC_BOUND_CLAMP = 0, /* the speed of each vertex is bounded (3.6, first method) */
  PLC_BOUND_SCALE = 1  /* the time step is scaled to the fastest vertex (3.6, second method) */
} plc_bound;

typedef enum plc_anisotropy PLC_INT {
  PLC_ANISOTROPY_PHYSICAL = 1, /* method 1 of 4.4: the mesh lives in mm; coarser than the
                                  shortest side of a voxel where one has more than 8 cubes of it */
  PLC_ANISOTROPY_VOXEL = 2,    /* method 2 of 4.4: the mesh lives in voxel proportions */
  PLC_ANISOTROPY_METRIC = 3    /* method 3 of 4.4: in those of each level, the forces in mm;
                                  may keep a level from rest */
} plc_anisotropy;

typedef enum plc_mesh_kind PLC_INT {
  PLC_MESH_UNIFORM = 0,  /* edges of one length everywhere, the voxels': the paper's (3.2) */
  PLC_MESH_ADAPTIVE = 1, /* edges by how much the image's iso-surface bends; sheets come as near to
                            each other as the image has them. Needs iso, and no springs. Crumbs,
                            components with fewer than 27 voxels of the object beneath them, are
                            left out at the end, but for the largest component and where it
                            starts from PLC_INIT_SEEDS, _MASK or _MESH */
  PLC_MESH_AUTO = 2 /* adaptive where the force is PLC_FORCE_ISO, without springs and edge, else
                       uniform; the surface's parameters tell which */
} plc_mesh_kind;

#define PLC_MAX_LEVELS 32

/* How long the edges of the result are. A uniform mesh is as fine as the image unless edge tells
 * otherwise. With v the shortest side of a voxel, delta is v / 1.2, and every edge is between delta
 * and 2.5 delta long, 0.83 v .. 2.08 v: 1.1 v to 1.5 v in the mean, 0.5 to 0.9 vertices to each
 * v * v of the surface. Where voxels are no cubes, PLC_ANISOTROPY_VOXEL and _METRIC count lengths
 * in voxels on each axis: in mm edges are longer along the longer sides. With
 * PLC_ANISOTROPY_PHYSICAL they are as long in mm in all directions; v there is doubled until a
 * voxel is at most 8 cubes of it. With edge, all lengths are edge / 1.25 v times these, and so is
 * what the surface resolves: longer edges round off and lose what is small, shorter ones follow the
 * interpolated image more closely.
 *
 * Those of an adaptive mesh are by place: where the image's iso-surface bends as a ball of radius R
 * they are about 3 sqrt(tolerance R) in the mean, but within edge_min .. edge_max; 1.6 v at most
 * around what was found late, and where the surface is folded though the image is not. Between two
 * voxels it lies where their values say, up to four windows beyond the window; a uniform one where
 * the values clipped to the window do.
 *
 * On a coarser level h everything is reduction^h times as long, as its voxels are. */
typedef struct plc_parameters {
  size_t struct_size;
  /* what to extract */
  double iso; /* in the image's units, within its range; NAN: not set, for PLC_FORCE_GRADIENT */
  int inside_below;                 /* 0: the object is where the image is >= iso; 1: <= iso */
  double level_iso[PLC_MAX_LEVELS]; /* pi_I per level, coarse to fine, in the image's units;
                                       since 0.3: before, I_0 came first */
  int level_iso_count;              /* 0: derived; else levels + 1. Coarse levels have values at
                                       which they show 95 % of the object of I_0, but where an
                                       adaptive mesh starts on a noisy image (levels) the finest
                                       of them has that of I_0 */
  double window_low, window_high;   /* image units mapped to 0 and 1; NAN: derived */
  double pad_value; /* what surrounds the image, not on the object's side of any iso-value (but for
                       PLC_FORCE_GRADIENT); NAN: the outside end of window */
  plc_feature feature;
  double feature_sigma; /* of the Gaussian, mm, >= 0; 0: none */
  /* the pyramid */
  int levels;       /* levels above I_0, the image; 0: direct; -1: 3, or fewer when that is small,
                       but 0 where init is PLC_INIT_AUTO, the mesh adaptive, late_bubbles 1, and of
                       the image's voxels at most a fifth - 16,384 in small ones, 2^21 in large
                       ones, with a memory_limit one for 2,400 bytes of that - are the object's
                       and at its surface, and noise moves that by no more than 5/3 of a voxel,
                       standard deviation: in more, a coarser level knows better where it is */
  double reduction; /* rho, 1 < rho <= 2: how much longer voxels are from level to level */
  /* the start */
  plc_init init;
  int bubbles[3]; /* each 1 .. 256 */
  /* the mesh, see above; lengths in mm where voxels have their shortest side, on I_0. 0: derived
     from the voxels; the result's parameters tell */
  plc_mesh_kind mesh;
  double edge; /* of a uniform mesh: about the mean of its edges, from a quarter of a voxel to a
                  tenth of the image's shortest side; 0: 1.25 voxels */
  double tolerance; /* of an adaptive mesh: the mean distance of its facets from a surface that
                       bends as the image's does, > 0; 0: 1/24 of a voxel */
  double edge_min, edge_max; /* of an adaptive mesh: mean edges lie between, an eighth of those of a
                                uniform mesh and 7.9 times those at most; 0: 0.625 and 5 voxels */
  /* the model */
  double curvature; /* alpha_c (5), >= 0: smooths; more for noise, less for thin parts */
  double spring;    /* alpha_e (6), >= 0: draws edges to rest_length, within what (1), (2) allow */
  plc_rest_length rest_length;
  double rest_length_value; /* in units of delta, >= 0 */
  plc_force force;
  double attraction;       /* |alpha_I| (7), > 0: how much the image counts against curvature */
  double gradient;         /* alpha_gradI (8), along the normal; < 0: away from bright */
  double gradient_tangent; /* beta_gradI (8), along the tangent plane; may keep a level from rest */
  double gradient_bound;   /* norm of the gradient, in window per U_h, at which (8) is 1; > 0 */
  double mass;             /* m (4), > 0 */
  double damping;          /* gamma (4), >= 0; times 2.8 in an adaptive mesh with an iso force and
                              without attachments: its vertices weigh by the stiffness of forces */
  double time_step;        /* dt, > 0; times 1.4 there; lowered where the forces make it unstable */
  double max_move;         /* bound of a vertex's movement per iteration, in delta, (0, 1] */
  plc_bound bound;
  plc_anisotropy anisotropy;
  double epsilon;     /* kinetic energy along the normals below which a level has converged, > 0. No
                         vertex counts more than 30 of it in a direct run of an adaptive mesh from
                         PLC_INIT_ISO, where what moves for long draws back from thin parts */
  double calm_speed;  /* also no vertex may be as fast, in delta per time; 0: not asked */
  int max_iterations; /* per level, >= 1; I_0 may take as many again after late bubbles */
  int late_bubbles;   /* 1: bubbles start in what a level's surface has missed; 0: as the paper.
                         None with PLC_FORCE_GRADIENT: nothing would hold them to iso */
  int sleeping;       /* 1: regions where nothing has moved for long are left alone until something
                         near them moves, and before a level ends; 0: never. Results differ within
                         what epsilon leaves open. Nothing sleeps with a force of the caller's */
} plc_parameters;

PLC_API void plc_parameters_defaults(plc_parameters* parameters);

typedef enum plc_parameter_kind PLC_INT {
  PLC_PARAMETER_REAL = 0,  /* double */
  PLC_PARAMETER_COUNT = 1, /* int */
  PLC_PARAMETER_FLAG = 2,  /* int, 0 or 1 */
  PLC_PARAMETER_CHOICE = 3 /* an enumeration */
} plc_parameter_kind;

/* A field of plc_parameters, for forms, bindings and files of settings. */
typedef struct plc_parameter_info {
  const char* name; /* the field's */
  plc_parameter_kind kind;
  size_t offset; /* of the field, in bytes */
  int count;     /* values side by side: 3 of bubbles, PLC_MAX_LEVELS of level_iso, else 1 */
  double value;  /* the default, of each; NAN, and -1 of levels: derived from the image */
  double lowest, highest;   /* what is valid, both included; NAN is where it is the default */
  const char* range;        /* the same in words, as in "must be 0 .. 1e6" */
  const char* const* words; /* CHOICE: the names of the values from lowest to highest; else NULL */
} plc_parameter_info;

/* The fields in their order, from 0; NULL where there are no more. They live as long as the
 * library; any thread may ask. */
PLC_API const plc_parameter_info* plc_parameter_at(int index);

typedef struct plc_progress {
  size_t struct_size;
  int level;     /* h of the image I_h in which the mesh evolves; counts down to 0 */
  int levels;    /* levels above I_0 */
  int iteration; /* of this level, from 1; 0, without vertices, while it makes the surface to start
                    from, of PLC_INIT_ISO, _MASK and _MESH */
  int64_t vertices;
  double energy;   /* kinetic energy along the normals, in m (delta / dt)^2 (5.1), as epsilon is
                      compared with it */
  double speed;    /* of the fastest vertex, in delta per time */
  double fraction; /* an estimate of what is done, 0 .. 1, never falling */
  double seconds;  /* of evolution so far; of a run, within all calls on it */
} plc_progress;

/* Called on the calling thread after every iteration, and now and then before the first. Return 0
 * to go on, any other to cancel. */
typedef int (*plc_progress_fn)(const plc_progress* progress, void* user);

typedef struct plc_seed {
  double centre[3];
  double radius; /* mm, > 0 */
} plc_seed;

/* A place that draws the surface near it along its normals until the surface goes through it (3.8):
 * the pull is strength times the distance along the normal, fading to 0 at the radius, damped so
 * that it does not swing. The strongest sets the time step of all: 100 is much. */
typedef struct plc_attachment {
  double place[3];
  double radius;   /* mm, > 0 */
  double strength; /* stiffness relative to the attraction, 0 .. 1e6 */
} plc_attachment;

/* A ball in which no force moves a vertex; transformations still keep the constraints there. */
typedef struct plc_pin {
  double place[3];
  double radius; /* mm, > 0 */
} plc_pin;

/* All living vertices, at one stage of Runge-Kutta. */
typedef struct plc_force_points {
  size_t struct_size;
  int level;
  int64_t count;
  const float* xyz;     /* 3 * count positions in the space of plc_extras */
  const float* normals; /* 3 * count outward unit normals in it */
} plc_force_points;

/* Writes 3 * count forces, which are 0 before, in the space of plc_extras. 1 is the pull of (7)
 * with attraction 1 on a vertex whose image value is a whole window away from iso; where the mesh
 * lives in voxels but forces are given in mm, that is so on the axes of the finest spacing, and
 * less on the others, whose voxels are longer. Four calls per iteration, or more with
 * PLC_BOUND_SCALE, all on the calling thread. Return 0 to go on, any other to cancel. A force that
 * is not finite, or above 1e6, ends the call with PLC_INVALID_ARGUMENT. */
typedef int (*plc_force_fn)(const plc_force_points* points, float* forces, void* user);

typedef struct plc_level_report plc_level_report;

typedef enum plc_verdict PLC_INT {
  PLC_VERDICT_ACCEPT = 0, /* on to the next level, as any value but these */
  PLC_VERDICT_MORE = 1,   /* up to max_iterations more on this level */
  PLC_VERDICT_STOP = 2,   /* the surface as it is is the result */
  PLC_VERDICT_CANCEL = 3  /* PLC_CANCELLED; a run that goes on asks again */
} plc_verdict;

/* The user's validation (5.1): called on the calling thread at the end of every level that holds a
 * surface, which may be asked for anything but must not be kept or freed. */
typedef plc_verdict (*plc_level_fn)(const plc_level_report* level, const plc_surface* surface,
                                    void* user);

/* What goes beyond an image and numbers. Everything is borrowed for the duration of the call. Up to
 * 2^24 seeds, attachments and pins, up to 2^32 vertices and faces. */
typedef struct plc_extras {
  size_t struct_size;
  plc_progress_fn progress; /* may be NULL, as all below */
  void* progress_user;
  plc_level_fn level;
  void* level_user;
  plc_force_fn force;
  void* force_user;
  plc_space space;       /* of all places below and of force.
                            Seeds, attachments and pins lie within the image: no more than half a
                            voxel from the outermost centres; else PLC_INVALID_ARGUMENT */
  const plc_seed* seeds; /* PLC_INIT_SEEDS: apart from each other, 1.15 delta or more in radius;
                            none reaches beyond the image by four diagonals of that */
  int64_t seed_count;
  const plc_image* mask;  /* PLC_INIT_MASK: as many voxels as the image; where not 0: the object */
  const double* mesh_xyz; /* PLC_INIT_MESH: closed, oriented, embedded, none beyond the image by
                             four diagonals of that; 3 * mesh_vertex_count */
  int64_t mesh_vertex_count;
  const uint32_t* mesh_abc; /* counter-clockwise seen from outside; 3 * mesh_face_count */
  int64_t mesh_face_count;
  const plc_attachment* attachments;
  int64_t attachment_count;
  const plc_pin* pins;
  int64_t pin_count;
  /* Faces that never move, and that the surface does not meet, exactly, nor pass over as a whole;
     where it comes nearer to them than the gap it is held. They may be open, and meet each other;
     none has zero area. levels and late_bubbles are 0 then. A surface to start from that meets them
     is refused with PLC_INVALID_DATA. 3 * obstacle_vertex_count, 3 * obstacle_face_count. */
  const double* obstacle_xyz;
  int64_t obstacle_vertex_count;
  const uint32_t* obstacle_abc;
  int64_t obstacle_face_count;
  double obstacle_gap; /* 0 .. 1, in delta: what lies nearer at the start comes no nearer */
  /* PLC_INIT_MESH: the mesh is a patch of a larger surface. A value per vertex. 1: held; it stays,
     to the bit, as does every face of three of them; 0: free; 2: free, and faces of three of these
     are refined first (3.4). A patch may be open where vertices of borders, and their neighbours,
     are held. Borders are closed by vertices that the surface has, too, but without faces: see
     plc_surface_patch(). Late bubbles start within the room alone; the run ends with the level that
     it begins on, and cannot be saved. Not NULL with no face: there is nothing but the room. */
  const uint8_t* mesh_held;
  /* With it: no vertex leaves this box by moving, voxel indices of the image. Those that are made
     on edges of held vertices may be outside, by no more than half an edge. */
  double room_low[3];
  double room_high[3];
  int room_inside; /* 1: without a face all of the room is the surface's inside; 0: outside */
} plc_extras;

/* Nothing, PLC_SPACE_LPS, an obstacle_gap of 0, room for everything. */
PLC_API void plc_extras_defaults(plc_extras* extras);

/* ---- extraction ------------------------------------------------------------------------- */

/* PyramidalRecoverShape (fig. 13). extras may be NULL. On any status but PLC_OK *surface is NULL.
 * The surface is closed, oriented outward and free of self-intersections. Levels of the pyramid are
 * freed as the surface leaves them: the least memory. What it will cost is estimated before it
 * starts and told to log: as a warning where the surface would have more vertices than the image
 * has voxels, as PLC_OUT_OF_MEMORY where not even a quarter of it would fit the memory limit.
 * PLC_INVALID_DATA where forces drive the surface away from the image without end. */
PLC_API plc_status plc_extract(plc_context* context, const plc_image* image,
                               const plc_parameters* parameters, const plc_extras* extras,
                               plc_surface** surface);
/* The same of a volume, of bricks or not. */
PLC_API plc_status plc_extract_volume(plc_context* context, const plc_volume* volume,
                                      const plc_parameters* parameters, const plc_extras* extras,
                                      plc_surface** surface);

/* The images I_0 .. I_levels of 4.2, normalised by the window, in the reduction, and the iso-values
 * pi_I on them. Reads of the parameters all up to `reduction`, and derives what they leave open;
 * where levels is -1, from init, mesh, late_bubbles, force, spring and edge, too.
 * The volume may be destroyed afterwards; where it borrows, its voxels must stay. May be used for
 * any number of runs, of any contexts, at the same time. PLC_INVALID_DATA: NaN or infinite voxels,
 * an image of 2^40 voxels or more or 2^31 in a plane, with its padding; a coarser level, or an
 * image of 32-bit integers, of 2^31 voxels or more; ...; PLC_INVALID_ARGUMENT: more levels than the
 * image has voxels for, iso out of its range, ... */
PLC_API plc_status plc_pyramid_create(plc_context* context, const plc_volume* volume,
                                      const plc_parameters* parameters, plc_pyramid** pyramid);
PLC_API void plc_pyramid_destroy(plc_pyramid* pyramid);
/* The parameters as given, with everything that was derived from the image filled in. */
PLC_API plc_status plc_pyramid_parameters(plc_context* context, const plc_pyramid* pyramid,
                                          plc_parameters* parameters);

typedef struct plc_pyramid_level {
  size_t struct_size;
  int64_t dims[3];   /* of I_h, padding included */
  double spacing[3]; /* mm */
  double origin[3];  /* LPS position of the centre of voxel (0,0,0) of I_h, mm; directions are those
                        of the image */
  double unit;       /* U_h, mm */
  double iso;        /* pi_I of this level, in the image's units; NAN: not set */
} plc_pyramid_level;
PLC_API void plc_pyramid_level_defaults(plc_pyramid_level* level);

/* Levels above I_0, so that 0 <= h <= it; -1 for NULL. */
PLC_API int plc_pyramid_levels(const plc_pyramid* pyramid);
PLC_API plc_status plc_pyramid_level_info(plc_context* context, const plc_pyramid* pyramid, int h,
                                          plc_pyramid_level* level);
/* The values of I_h in [0,1], x fastest. capacity: how many values there is room for, at least
 * dims[0] * dims[1] * dims[2] of the level. */
PLC_API plc_status plc_pyramid_values(plc_context* context, const plc_pyramid* pyramid, int h,
                                      float* values, int64_t capacity);

/* ---- runs ------------------------------------------------------------------------------- */

/* An evolution in progress, for hosts that want to look at the surface, save it, or stop between
 * any two iterations. Exactly plc_extract, in as many calls as one likes.
 *
 * parameters: those that the pyramid was made with, or plc_pyramid_parameters() of it; what the
 * pyramid does not read may differ. extras may be NULL; its callbacks are made during the calls
 * below, and their user pointers are kept; all else of it is copied. The pyramid may be destroyed.
 * The run holds the initial surface (3.6) of the coarsest level that shows the object;
 * PLC_CANCELLED, without a run, where progress says so while that is made.
 *
 * A call that fails with PLC_CANCELLED leaves the run between two iterations: it can go on. After
 * any other failure the run has ended without a result: its calls fail with PLC_INVALID_ARGUMENT
 * until it is destroyed. */
PLC_API plc_status plc_run_create(plc_context* context, const plc_pyramid* pyramid,
                                  const plc_parameters* parameters, const plc_extras* extras,
                                  plc_run** run);
PLC_API void plc_run_destroy(plc_run* run);

typedef enum plc_amount PLC_INT {
  PLC_ONE_ITERATION = 0, /* procedure Evolution, figure 9 */
  PLC_ONE_LEVEL = 1,     /* to the end of the level, RecoverShape, figure 12 */
  PLC_ALL_LEVELS = 2     /* to the end, PyramidalRecoverShape, figure 13 */
} plc_amount;

typedef struct plc_run_state {
  size_t struct_size;
  int done;           /* 1: I_0 has been left, or the level callback has said PLC_VERDICT_STOP */
  int between_levels; /* 1: the level below has come to its end, the next call starts the next one,
                         or there is none */
  plc_progress
      progress; /* of the last iteration; zeros before the first, but the fraction. Its seconds are
                   those spent within calls on this run, or before it was saved */
} plc_run_state;
PLC_API void plc_run_state_defaults(plc_run_state* state);

/* Goes on until the amount is done, or the run is. state may be NULL; it is written where the
 * status is PLC_OK. A run that is done stays so: PLC_OK. Callbacks may not use the run. */
PLC_API plc_status plc_run_advance(plc_context* context, plc_run* run, plc_amount amount,
                                   plc_run_state* state);
/* The same without going on: of a run that was made, restored or cancelled just now. */
PLC_API plc_status plc_run_get_state(plc_context* context, const plc_run* run,
                                     plc_run_state* state);
/* The surface as it is now, a copy, with the levels so far: closed, oriented and free of
 * self-intersections after every iteration. Where the run is done, what plc_extract gives. */
PLC_API plc_status plc_run_surface(plc_context* context, const plc_run* run, plc_surface** surface);

/* The state between two iterations, as bytes that any context of this version of the library on a
 * machine of this byte order takes, whatever its threads and SIMD target. *size: of the state;
 * written in any case but an error. state: room for capacity bytes, nothing is written where that
 * is too little, which is no error where state is NULL (capacity 0) and else PLC_INVALID_ARGUMENT.
 * Neither image nor callbacks are in it; seeds, mesh, mask, attachments and pins are not either. */
PLC_API plc_status plc_run_save(plc_context* context, const plc_run* run, void* state,
                                size_t capacity, size_t* size);
/* A run that goes on from a saved state, with the bits that the saved one would have gone on to.
 * pyramid, its frame included, parameters and extras: equal to those of the saved run, callbacks
 * aside, but with a force where that had one, in the same space; the mask is needed where init is
 * PLC_INIT_MASK. PLC_INVALID_DATA where the bytes are no state of a run, of
 * another version, truncated or altered, or of another pyramid, parameters or extras. */
PLC_API plc_status plc_run_restore(plc_context* context, const plc_pyramid* pyramid,
                                   const plc_parameters* parameters, const plc_extras* extras,
                                   const void* state, size_t size, plc_run** run);

/* ---- surface ---------------------------------------------------------------------------- */

/* Functions of a surface may be called by several threads at the same time, with a context each. */
PLC_API void plc_surface_destroy(plc_surface* surface);

/* A mesh from elsewhere: closed, oriented, free of self-intersections, else PLC_INVALID_DATA and a
 * message that tells what is wrong and where. xyz: 3 * vertex_count values in `space`; abc: 3 *
 * face_count indices, counter-clockwise seen from outside in it. image: where the mesh lies - its
 * dims and voxels are not read; NULL: spacing 1, origin 0, identity. Coordinates are rounded to
 * floats of voxels; vertices without a face are dropped, others keep their order; the surface has
 * no levels, the default parameters, range and seconds of 0. To start a run from: PLC_INIT_MESH. */
PLC_API plc_status plc_surface_create(plc_context* context, plc_space space, const plc_image* image,
                                      const double* xyz, int64_t vertex_count, const uint32_t* abc,
                                      int64_t face_count, plc_surface** surface);

/* 0 for NULL. */
PLC_API int64_t plc_surface_vertex_count(const plc_surface* surface);
PLC_API int64_t plc_surface_face_count(const plc_surface* surface);
/* xyz: 3 * vertex_count floats. capacity, here and below: how many vertices or faces there is room
 * for; PLC_INVALID_ARGUMENT where there are more. Vertices are in the engine's canonical order. */
PLC_API plc_status plc_surface_positions(plc_context* context, const plc_surface* surface,
                                         plc_space space, float* xyz, int64_t capacity);
/* As plc_surface_positions, in doubles: the engine's mesh, mapped to the space with no rounding to
 * floats in it, which makes faces meet where the surface lies millions of voxels away from the
 * space's origin, and rarely where parts of it all but touch; plc_mesh_round mends the latter. */
PLC_API plc_status plc_surface_positions_f64(plc_context* context, const plc_surface* surface,
                                             plc_space space, double* xyz, int64_t capacity);
/* Where the surface went round in circles and was frozen, so that its level could end: connected
 * vertices that stay where they are, those of most vertices first. The surface is as valid there as
 * anywhere, but is not where its forces would have it. count: how many sites there are, always set
 * where the other arguments are right. xyz: 3 doubles for each, the mean of its vertices; NULL:
 * only the count is asked for. vertices: how many these are, may be NULL. capacity: sites there is
 * room for; PLC_INVALID_ARGUMENT, and nothing but the count written, where there are more. */
PLC_API plc_status plc_surface_frozen_sites(plc_context* context, const plc_surface* surface,
                                            plc_space space, double* xyz, int64_t* vertices,
                                            int64_t capacity, int64_t* count);
/* Of a surface that has evolved as a patch (mesh_held of plc_extras). source: one value per vertex:
 * the index of the vertex of the mesh given that it is, held; PLC_PATCH_FREE: a free one;
 * PLC_PATCH_ABSENT: it has closed a border, and has no face. Of all other surfaces every vertex is
 * free. */
#define PLC_PATCH_FREE (-1)
#define PLC_PATCH_ABSENT (-2)
PLC_API plc_status plc_surface_patch(plc_context* context, const plc_surface* surface,
                                     int64_t* source, int64_t capacity);
/* abc: 3 * face_count indices, counter-clockwise seen from outside in the given space. */
PLC_API plc_status plc_surface_faces(plc_context* context, const plc_surface* surface,
                                     plc_space space, uint32_t* abc, int64_t capacity);
/* xyz: 3 * vertex_count floats, unit normals, outward. */
PLC_API plc_status plc_surface_normals(plc_context* context, const plc_surface* surface,
                                       plc_space space, float* xyz, int64_t capacity);

typedef enum plc_scalar PLC_INT {
  PLC_SCALAR_MEAN_CURVATURE = 0,     /* as plc_mesh_curvature, of the mesh in the space */
  PLC_SCALAR_GAUSSIAN_CURVATURE = 1, /* the same */
  PLC_SCALAR_AREA = 2,               /* the mixed area of the vertex, the same */
  PLC_SCALAR_VALENCE = 3,            /* number of neighbours */
  PLC_SCALAR_MOVEMENT = 4 /* of the last iteration along the normal, in delta: where it is not small
                             the surface has not come to rest. 0 of a mesh from elsewhere */
} plc_scalar;
/* values: vertex_count floats; NAN as plc_mesh_curvature. */
PLC_API plc_status plc_surface_scalars(plc_context* context, const plc_surface* surface,
                                       plc_space space, plc_scalar scalar, float* values,
                                       int64_t capacity);
/* 64-bit FNV-1a over, in this order: the number of vertices (u64), the bits of the positions in
 * the engine's mesh space (x, y, z of vertex 0, 1, ...: three u32 each), then each vertex's valence
 * (u32) and ring (u32 each, from its smallest neighbour on, counter-clockwise); little endian. 0
 * for NULL. */
PLC_API uint64_t plc_surface_hash(const plc_surface* surface);

/* What a mesh is: of the whole, over all components. */
typedef struct plc_measures {
  size_t struct_size;
  int64_t vertices, faces;
  int64_t components; /* of faces adjacent by an edge */
  int64_t euler;      /* V - E + F */
  int64_t genus;      /* sum over the components, for closed orientable ones; else -1 */
  double area;        /* of the space measured in, squared (mm2 in patient space) */
  double volume;      /* signed: > 0 when faces are outward */
} plc_measures;
PLC_API void plc_measures_defaults(plc_measures* measures);
PLC_API plc_status plc_surface_measure(plc_context* context, const plc_surface* surface,
                                       plc_space space, plc_measures* measures);
/* See plc_check_mesh; in mm. Of the surface as the engine holds it: coordinates that are written in
 * floats of a space far from its origin may tell less. */
typedef struct plc_check plc_check;
PLC_API plc_status plc_surface_check(plc_context* context, const plc_surface* surface,
                                     plc_check* check);

/* How the surface came to be, level by level. */
struct plc_level_report {
  size_t struct_size;
  int level;       /* h */
  int64_t dims[3]; /* of I_h, padding included */
  double unit;     /* U_h, mm */
  double delta;    /* of (1)-(3), the length of the shortest edge, in mesh units (voxels of I_0 by
                      default) */
  double iso;      /* pi_I of this level, in the image's units */
  int64_t iterations;
  int64_t vertices; /* at the end of the level */
  int converged;    /* 0: max_iterations ended it before it came to rest */
  double energy;    /* at the end */
  double speed;     /* of the fastest vertex at the end, in delta per time */
  double seconds_topology, seconds_normals, seconds_dynamics, seconds_total;
  int64_t creations, inversions, deletions, annular, axial, tetrahedra, refinements;
  int64_t deferred;                    /* operations that a limit put off to the next iteration */
  int64_t late_bubbles, late_cavities; /* started in parts and cavities that had been missed */
  double late_volume;                  /* of all of them as they started, mm3 */
  int64_t moves;  /* of single vertices; those that sleep are left out, in blocks of 16 */
  int64_t checks; /* of single vertices' constraints after a movement (3.6, slow vertices) */
  /* At the end: sites that would never have come to rest - noise, parts thinner than (3) allows -
   * and were frozen, and their vertices. See plc_surface_frozen_sites. */
  int64_t frozen_sites, frozen_vertices;
};
PLC_API void plc_level_report_defaults(plc_level_report* report);
/* index: 0 .. plc_surface_level_count - 1, from coarse to fine. 0 levels for NULL. */
PLC_API int plc_surface_level_count(const plc_surface* surface);
PLC_API plc_status plc_surface_level(plc_context* context, const plc_surface* surface, int index,
                                     plc_level_report* report);
/* 1: every level on which there is a surface came to rest, and so the result has. 0: max_iterations
 * ended one before that, or it is the surface of a run on a level that has not ended: the surface
 * is as valid, but may not have come to where its forces would have it. plc_surface_level tells
 * which. Frozen sites are at rest. 1 of a mesh from elsewhere, 0 for NULL. */
PLC_API int plc_surface_converged(const plc_surface* surface);
/* Where the time of an extraction went, seconds. */
typedef struct plc_seconds {
  size_t struct_size;
  double preparation; /* all before the evolution: range, window, pyramid, iso-values */
  double images;      /* of it: the images of the pyramid alone */
  double evolution;
} plc_seconds;
PLC_API void plc_seconds_defaults(plc_seconds* seconds);
PLC_API plc_status plc_surface_seconds(plc_context* context, const plc_surface* surface,
                                       plc_seconds* seconds);
/* The parameters as used, with everything that was derived filled in. */
PLC_API plc_status plc_surface_parameters(plc_context* context, const plc_surface* surface,
                                          plc_parameters* parameters);
/* Smallest and largest voxel of the input. */
PLC_API plc_status plc_surface_input_range(plc_context* context, const plc_surface* surface,
                                           double* low, double* high);

/* ---- checking any mesh ------------------------------------------------------------------ */

struct plc_check {
  size_t struct_size;
  plc_measures measures;
  int valid;    /* closed, manifold, oriented, outward, no degenerate face, no self-intersection */
  int closed;   /* every edge has an even, non-zero number of faces, no repeated index in a face */
  int manifold; /* no edge of > 2 faces, no vertex with > 1 umbrella */
  int oriented; /* both faces of each edge run it in opposite directions */
  int outward;  /* each component faces outward, walls of cavities inward; -1: not defined */
  int64_t border_edges, non_manifold_edges, non_manifold_vertices, inconsistent_edges;
  int64_t wrongly_oriented_components;
  int64_t degenerate_faces; /* of exactly zero area, or with a repeated index */
  int64_t duplicate_points; /* whose coordinates equal those of an earlier point */
  int64_t isolated_vertices;
  int64_t self_intersections;    /* pairs of faces that meet elsewhere than in what they share */
  int64_t first_intersection[2]; /* the first such pair; -1, -1 */
  double edge_min, edge_mean, edge_max;
  double min_angle, max_angle; /* degrees */
  int32_t valence_min, valence_max;
};
PLC_API void plc_check_defaults(plc_check* check);

/* xyz: 3 * vertex_count finite values; abc: 3 * face_count indices below vertex_count. Predicates
 * are exact. The faces around one vertex are compared each with each: a million of them would take
 * hours. PLC_INVALID_DATA where an index or a value is out of range; an invalid mesh is PLC_OK
 * with check->valid == 0. */
PLC_API plc_status plc_check_mesh(plc_context* context, const double* xyz, int64_t vertex_count,
                                  const uint32_t* abc, int64_t face_count, plc_check* check);

/* ---- measuring any mesh ----------------------------------------------------------------- */

/* Every function here takes a mesh as plc_check_mesh does (xyz: 3 * vertex_count finite values, 0
 * or of magnitudes 1e-70 .. 1e70; abc: 3 * face_count indices below vertex_count; NULL only where
 * there are none) and fails with PLC_INVALID_ARGUMENT for impossible counts and NULL where it must
 * not be, PLC_INVALID_DATA for a value or an index out of range. Outputs are then unchanged. The
 * mesh need not be closed, manifold or oriented, unless said otherwise. */

/* A component (faces adjacent by an edge), or all of them together. Lengths are in the unit of the
 * coordinates. Moments are of the enclosed volume with density 1 and signed as it: negative where
 * faces point inward, so that in sums the cavities count as holes. Magnitudes beyond 1e50 or below
 * 1e-50 may over- or underflow in them. */
typedef struct plc_component_measures {
  size_t struct_size;
  int64_t first_face;      /* the smallest face of it; 0 for all together */
  int64_t vertices, faces; /* a vertex where a component touches itself counts again in it, one of
                              no face counts in all together only */
  int64_t euler;           /* V - E + F, of the faces and their vertices */
  int64_t genus; /* -1 unless closed and consistently oriented; the sum for all together */
  double area;
  double volume; /* > 0 when faces are outward; NAN unless each edge is run as often one way as
                    the other, as in a closed, oriented surface */
  double low[3]; /* the corners of the bounding box of the faces; 0 for an empty mesh */
  double high[3];
  double centroid[3]; /* of the enclosed volume; NAN, as all that follows, where that is 0 or NAN */
  double moments[6];  /* second moments about the centroid c: the integral over the volume of
                         (x - c)(x - c)^T: xx, yy, zz, xy, yz, zx. The inertia tensor is their trace
                         times the identity less this: 2/5 r^2 volume for a ball about any axis */
  double principal_moments[3]; /* eigenvalues of the second moments, the largest first: the first
                                  axis is the longest one of a solid */
  double principal_axes[9];    /* unit, a right-handed frame: [3 i + k] is component k of axis i */
} plc_component_measures;
PLC_API void plc_component_measures_defaults(plc_component_measures* measures);

/* whole: of all components together, or NULL. components: the first min(capacity, *count) of them,
 * the largest area first, ties by first_face; NULL where capacity is 0. *count: how many there are;
 * ask with capacity 0 for it. whole->struct_size must be set; that of components is written. */
PLC_API plc_status plc_mesh_component_measures(plc_context* context, const double* xyz,
                                               int64_t vertex_count, const uint32_t* abc,
                                               int64_t face_count, plc_component_measures* whole,
                                               plc_component_measures* components, int64_t capacity,
                                               int64_t* count);

/* Curvatures of a smooth surface that the mesh stands for, per vertex: the mean one by the
 * cotangent Laplacian along the normal, the Gaussian one by the angle defect, both over the mixed
 * Voronoi area of Meyer, Desbrun, Schroeder & Barr, "Discrete Differential-Geometry Operators for
 * Triangulated 2-Manifolds", 2003. Where faces are outward a ball of radius r has 1 / r (positive:
 * convex) and 1 / r^2. mean, gaussian, area: vertex_count values, each may be NULL. NAN for mean
 * and gaussian of a vertex on a border or an edge of more than two faces, or of no area. area is
 * the mixed area: their sum is the area of the mesh, and the sum of gaussian * area over a closed
 * manifold mesh is 2 pi euler to rounding (Gauss-Bonnet). */
PLC_API plc_status plc_mesh_curvature(plc_context* context, const double* xyz, int64_t vertex_count,
                                      const uint32_t* abc, int64_t face_count, double* mean,
                                      double* gaussian, double* area);

/* The vertex of a face nearest to a point, the first of equal ones; -1 where there is no face.
 * point: three finite values. */
PLC_API plc_status plc_mesh_nearest_vertex(plc_context* context, const double* xyz,
                                           int64_t vertex_count, const uint32_t* abc,
                                           int64_t face_count, const double* point,
                                           int64_t* vertex);

/* The length of the shortest path over the faces from vertex source, 0 .. vertex_count - 1, to each
 * vertex: exact for the polyhedron but for rounding (about 1e-12 of it). distance: vertex_count
 * values; INFINITY where no path leads. Where lengths differ by so much that sums lose the short
 * ones, some may be those of a path that is not the shortest. Paths cross borders nowhere and edges
 * of any number of faces. The time grows like vertex_count^1.5 on usual meshes; one thread. */
PLC_API plc_status plc_mesh_geodesic(plc_context* context, const double* xyz, int64_t vertex_count,
                                     const uint32_t* abc, int64_t face_count, int64_t source,
                                     double* distance);

/* Distances from a mesh to the nearest points of the faces of another, unsigned. mean and rms are
 * over the area of the first mesh, by a rule of seven points in each face (corners, middles of
 * edges, centre) that is exact where the distance is a cubic; max is of all these points: at most,
 * and for small faces nearly, the one-sided Hausdorff distance. */
typedef struct plc_distances {
  size_t struct_size;
  double mean, rms, max;
  double vertex_mean, vertex_max; /* of the first mesh's vertices alone */
} plc_distances;
PLC_API void plc_distances_defaults(plc_distances* distances);

/* distance: one value per vertex of the first mesh, or NULL. summary may be NULL, else struct_size
 * must be set; NAN in it where the first mesh has no area (mean, rms) or no vertex (the others).
 * PLC_INVALID_DATA where the other mesh has no face. */
PLC_API plc_status plc_mesh_distance(plc_context* context, const double* xyz, int64_t vertex_count,
                                     const uint32_t* abc, int64_t face_count,
                                     const double* other_xyz, int64_t other_vertex_count,
                                     const uint32_t* other_abc, int64_t other_face_count,
                                     double* distance, plc_distances* summary);

/* ---- simplifying any mesh --------------------------------------------------------------- */

/* How far something has come, 0 .. 1, never falling. Return 0 to go on, any other to cancel. */
typedef int (*plc_fraction_fn)(double fraction, void* user);

typedef struct plc_simplify_options {
  size_t struct_size;
  double tolerance;         /* > 0, in the unit of the coordinates; has no default */
  int32_t one_sided;        /* not 0: the result is near the mesh, but need not be the other way */
  plc_fraction_fn progress; /* on the calling thread, now and then; NULL: nobody asks */
  void* progress_user;
} plc_simplify_options;
PLC_API void plc_simplify_options_defaults(plc_simplify_options* options);

/* What has become of a mesh. Distances are from the places of all faces, not of vertices alone, to
 * the nearest place of the other mesh. They are measured when all is done, whatever has been proved
 * on the way: at_least is that of some place; at_most is exceeded by none, but for rounding, and is
 * at most 2 % above the larger of at_least and an eighth of the tolerance. */
typedef struct plc_simplified {
  size_t struct_size;
  int64_t vertices, faces;
  double from_at_least, from_at_most; /* from the result to the mesh that was given */
  double to_at_least, to_at_most;     /* from the mesh that was given to the result */
} plc_simplified;
PLC_API void plc_simplified_defaults(plc_simplified* simplified);

/* A mesh of fewer vertices, no place of which is farther than the tolerance from the given one nor,
 * unless one_sided, a place of that from it: both Hausdorff distances, proved. The mesh must be
 * valid (plc_check_mesh), else PLC_INVALID_DATA; so is the result, exactly, with the same
 * components, genus and orientation. The tolerance must be at least 1e-12 of the largest
 * coordinate. Where all coordinates are floats, so are those of the result. Edges are collapsed,
 * those of the least quadric error (Garland and Heckbert, 1997) first, until none is left that
 * could be.
 *
 * new_xyz: room for 3 * vertex_count values; new_abc: for 3 * face_count indices; they must not
 * overlap the mesh. What is written to them are simplified->vertices and ->faces. struct_size of
 * simplified must be set. PLC_CANCELLED where progress asks. */
PLC_API plc_status plc_mesh_simplify(plc_context* context, const double* xyz, int64_t vertex_count,
                                     const uint32_t* abc, int64_t face_count,
                                     const plc_simplify_options* options, double* new_xyz,
                                     uint32_t* new_abc, plc_simplified* simplified);

/* Rounds a valid mesh to floats that are one, too, for programs and file formats that have no
 * doubles. Where surfaces all but touch, rounding alone makes faces meet: their corners are moved
 * apart, by a few times what floats are rounded by there and by a 64th of their shortest edge at
 * most for each pair of such faces, in each of a few turns. rounded: room for 3 * vertex_count
 * floats. moved: of how many vertices it is not what rounding alone gives; may be NULL.
 * PLC_INVALID_DATA where the mesh is not valid, or floats do not hold it: it is too small beside
 * its distance from the origin. Nothing is written then. */
PLC_API plc_status plc_mesh_round(plc_context* context, const double* xyz, int64_t vertex_count,
                                  const uint32_t* abc, int64_t face_count, float* rounded,
                                  int64_t* moved);

#ifdef __cplusplus
}
#endif

#endif
