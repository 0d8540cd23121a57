/* Pellicle: closed, oriented, non-self-intersecting triangulated surfaces from 3D images.
 *
 * The C API of the engine; the only installed header. It implements Lachaud & Montanvert,
 * "Deformable Meshes with Automated Topology Changes for Coarse-to-fine 3D Surface Extraction";
 * numbers in parentheses are its equations, section numbers are its sections.
 *
 * - Every function that can fail returns a plc_status; plc_context_message() then says in one line
 *   what was wrong. No function exits, prints or throws.
 * - A context may be used by one thread at a time; different contexts are independent.
 * - Structs start with struct_size: fill them with their _defaults function, then change fields.
 * - Handles are freed with their _destroy function, which takes NULL.
 * - Results are the same bits for any thread count and any SIMD target.
 */
#ifndef PLC_PELLICLE_H
#define PLC_PELLICLE_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define PLC_API
#else
#define PLC_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum plc_status {
  PLC_OK = 0,
  PLC_INVALID_ARGUMENT = 1, /* a parameter is outside its range */
  PLC_INVALID_DATA = 2,     /* the image or mesh cannot be used */
  PLC_OUT_OF_MEMORY = 3,
  PLC_CANCELLED = 4, /* a callback asked to stop */
  PLC_INTERNAL = 5   /* a bug of the engine, caught before it did harm */
} plc_status;

typedef enum plc_simd {
  PLC_SIMD_AUTO = 0, /* the best of this machine */
  PLC_SIMD_SCALAR = 1,
  PLC_SIMD_SSE4 = 2,
  PLC_SIMD_AVX2 = 3,
  PLC_SIMD_AVX512 = 4
} plc_simd;

typedef enum plc_voxel_type {
  PLC_U8 = 0,
  PLC_I16 = 1,
  PLC_U16 = 2,
  PLC_I32 = 3,
  PLC_F32 = 4
} plc_voxel_type;

typedef enum plc_space {
  PLC_SPACE_LPS = 0,  /* patient space, mm, x to the left, y to the back, z to the head (as ITK) */
  PLC_SPACE_RAS = 1,  /* patient space, mm, x to the right, y to the front, z to the head */
  PLC_SPACE_VOXEL = 2 /* voxel indices of the input image, voxel centres at integers */
} plc_space;

typedef struct plc_context plc_context;
typedef struct plc_surface plc_surface;

/* "MAJOR.MINOR.PATCH"; static storage. */
PLC_API const char* plc_version_string(void);

/* ---- context ---------------------------------------------------------------------------- */

typedef struct plc_context_options {
  size_t struct_size;
  int threads;   /* worker threads, 1 .. 1024; 0: one per core */
  plc_simd simd; /* must be available on this machine */
} plc_context_options;

PLC_API void plc_context_options_defaults(plc_context_options* options);
/* options may be NULL (defaults). On failure *context is NULL and, where error is not NULL, a line
 * of at most error_size - 1 characters is written to it. */
PLC_API plc_status plc_context_create(const plc_context_options* options, plc_context** context,
                                      char* error, size_t error_size);
PLC_API void plc_context_destroy(plc_context* context);
/* The message of the last call on this context that failed; "" when none. Valid until the next
 * call on the context. */
PLC_API const char* plc_context_message(const plc_context* context);
/* The number of threads and the SIMD target in use ("scalar", "sse4", "avx2", "avx512"). */
PLC_API int plc_context_threads(const plc_context* context);
PLC_API const char* plc_context_simd(const plc_context* context);

/* ---- extraction ------------------------------------------------------------------------- */

/* An image in memory; borrowed for the duration of a call. */
typedef struct plc_image {
  size_t struct_size;
  plc_voxel_type type;
  const void* voxels;  /* dims[0] * dims[1] * dims[2] values, x fastest */
  int64_t dims[3];     /* each >= 2 */
  double spacing[3];   /* mm between voxel centres, > 0 */
  double origin[3];    /* LPS position of the centre of voxel (0,0,0), mm */
  double direction[9]; /* row-major, columns are the unit axes of the image in LPS (as ITK) */
} plc_image;

/* Spacing 1, origin 0, identity direction, no voxels. */
PLC_API void plc_image_defaults(plc_image* image);

typedef enum plc_rest_length {
  PLC_REST_ZERO = 0, /* minimise the area (membrane) */
  PLC_REST_MEAN = 1, /* the mean edge length of the mesh at each step */
  PLC_REST_VALUE = 2 /* rest_length_value */
} plc_rest_length;

/* The surface that the evolution starts from (3.6), on the coarsest level. */
typedef enum plc_init {
  PLC_INIT_BUBBLE = 0,  /* one bubble around the object; around the image where iso is NAN */
  PLC_INIT_BUBBLES = 1, /* bubbles[0] x bubbles[1] x bubbles[2] bubbles over the image */
  PLC_INIT_SEEDS = 2,   /* the spheres of plc_extras */
  PLC_INIT_ISO = 3,  /* the iso-surface of the coarsest image, closed at the border (figure 23) */
  PLC_INIT_MASK = 4, /* the surface of the mask of plc_extras, reduced like the image */
  PLC_INIT_MESH = 5  /* the mesh of plc_extras, brought to satisfy (1)-(3) */
} plc_init;

/* Which forces of the image act (3.8). */
typedef enum plc_force {
  PLC_FORCE_ISO = 1,      /* (7): towards the value iso */
  PLC_FORCE_GRADIENT = 2, /* (8): along the gradient; iso may be NAN */
  PLC_FORCE_BOTH = 3
} plc_force;

/* What the evolution takes for the image; iso, window and pad are values of it. */
typedef enum plc_feature {
  PLC_FEATURE_NONE = 0,         /* the image itself */
  PLC_FEATURE_GRADIENT_NORM = 1 /* the norm of its gradient, per mm, after a Gaussian (3.8) */
} plc_feature;

typedef enum plc_bound {
  PLC_BOUND_CLAMP = 0, /* the speed of each vertex is bounded (3.6, first method) */
  PLC_BOUND_SCALE = 1  /* the time step is scaled to the fastest vertex (3.6, second method) */
} plc_bound;

typedef enum plc_anisotropy {
  PLC_ANISOTROPY_PHYSICAL = 1, /* method 1 of 4.4: the mesh lives in mm */
  PLC_ANISOTROPY_VOXEL = 2,    /* method 2 of 4.4: the mesh lives in voxel proportions */
  PLC_ANISOTROPY_METRIC = 3    /* method 3 of 4.4: in those of each level, the forces in mm */
} plc_anisotropy;

#define PLC_MAX_LEVELS 32

typedef struct plc_parameters {
  size_t struct_size;
  /* what to extract */
  double iso; /* in the image's units, within its range; NAN: not set, for PLC_FORCE_GRADIENT */
  int inside_below;                 /* 0: the object is where the image is >= iso; 1: <= iso */
  double level_iso[PLC_MAX_LEVELS]; /* pi_I per level, [0] for I_0, in the image's units */
  int level_iso_count;              /* 0: derived; else levels + 1 */
  double window_low, window_high;   /* image units mapped to 0 and 1; NAN: derived */
  double pad_value;                 /* what surrounds the image; NAN: the outside end of window */
  plc_feature feature;
  double feature_sigma; /* of the Gaussian, mm, >= 0; 0: none */
  /* the pyramid */
  int levels;       /* levels above I_0; -1: 3, or fewer when the image is small; 0: direct */
  double reduction; /* rho, 1 < rho <= 2 */
  /* the start */
  plc_init init;
  int bubbles[3]; /* each 1 .. 256 */
  /* the model */
  double curvature; /* alpha_c (5), >= 0 */
  double spring;    /* alpha_e (6), >= 0 */
  plc_rest_length rest_length;
  double rest_length_value; /* in units of delta, >= 0 */
  plc_force force;
  double attraction;       /* |alpha_I| (7), > 0 */
  double gradient;         /* alpha_gradI (8), along the normal; < 0: away from bright */
  double gradient_tangent; /* beta_gradI (8), along the tangent plane */
  double gradient_bound;   /* norm of the gradient, in window per U_h, at which (8) is 1; > 0 */
  double mass;             /* m (4), > 0 */
  double damping;          /* gamma (4), >= 0 */
  double time_step;        /* dt, > 0; lowered where the forces make it unstable */
  double max_move;         /* bound of a vertex's movement per iteration, in delta, (0, 1] */
  plc_bound bound;
  plc_anisotropy anisotropy;
  double epsilon;     /* kinetic energy along the normals below which a level has converged, > 0 */
  double calm_speed;  /* also no vertex may be as fast, in delta per time; 0: not asked */
  int max_iterations; /* per level, >= 1; I_0 may take as many again after late bubbles */
  int late_bubbles;   /* 1: bubbles start in what a level's surface has missed; 0: as the paper.
                         None with PLC_FORCE_GRADIENT: nothing would hold them to iso */
  int sleeping;       /* 1: regions where nothing has moved for long are left alone until something
                         near them moves, and before a level ends; 0: never. Results differ within
                         what epsilon leaves open. Nothing sleeps with a force of the caller's */
  int slow_vertices;  /* 1: the constraints of a vertex are checked when it has moved far enough, or
                         after a while (3.6); 0: in every iteration */
  int renumbering;    /* 1: vertices are numbered along a space-filling curve; 0: as they come,
                         which is slower; for comparisons */
} plc_parameters;

PLC_API void plc_parameters_defaults(plc_parameters* parameters);

typedef struct plc_progress {
  size_t struct_size;
  int level;     /* h of the image I_h in which the mesh evolves; counts down to 0 */
  int levels;    /* levels above I_0 */
  int iteration; /* of this level, from 1 */
  int64_t vertices;
  double energy;   /* kinetic energy along the normals, in m (delta / dt)^2 (5.1) */
  double speed;    /* of the fastest vertex, in delta per time */
  double fraction; /* an estimate of what is done, 0 .. 1, never falling */
  double seconds;  /* since the start of the call */
} plc_progress;

/* Called on the calling thread after every iteration. Return 0 to go on, any other to cancel. */
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
 * is not finite ends the call with PLC_INVALID_ARGUMENT. */
typedef int (*plc_force_fn)(const plc_force_points* points, float* forces, void* user);

typedef struct plc_level_report plc_level_report;

typedef enum plc_verdict {
  PLC_VERDICT_ACCEPT = 0, /* on to the next level */
  PLC_VERDICT_MORE = 1,   /* up to max_iterations more on this level */
  PLC_VERDICT_STOP = 2    /* the surface as it is is the result */
} plc_verdict;

/* The user's validation (5.1): called on the calling thread at the end of every level that holds a
 * surface, which may be asked for anything but must not be kept or freed. */
typedef plc_verdict (*plc_level_fn)(const plc_level_report* level, const plc_surface* surface,
                                    void* user);

/* What goes beyond an image and numbers. Everything is borrowed for the duration of the call. */
typedef struct plc_extras {
  size_t struct_size;
  plc_progress_fn progress; /* may be NULL, as all below */
  void* progress_user;
  plc_level_fn level;
  void* level_user;
  plc_force_fn force;
  void* force_user;
  plc_space space;       /* of all places below and of force */
  const plc_seed* seeds; /* PLC_INIT_SEEDS: apart from each other, 1.15 delta or more in radius */
  int64_t seed_count;
  const plc_image* mask;  /* PLC_INIT_MASK: as many voxels as the image; where not 0: the object */
  const double* mesh_xyz; /* PLC_INIT_MESH: closed, oriented, embedded; 3 * mesh_vertex_count */
  int64_t mesh_vertex_count;
  const uint32_t* mesh_abc; /* counter-clockwise seen from outside; 3 * mesh_face_count */
  int64_t mesh_face_count;
  const plc_attachment* attachments;
  int64_t attachment_count;
  const plc_pin* pins;
  int64_t pin_count;
} plc_extras;

/* Nothing, PLC_SPACE_LPS. */
PLC_API void plc_extras_defaults(plc_extras* extras);

/* PyramidalRecoverShape (fig. 13). extras may be NULL. On any status but PLC_OK *surface is NULL.
 * The surface is closed, oriented outward and free of self-intersections. */
PLC_API plc_status plc_extract(plc_context* context, const plc_image* image,
                               const plc_parameters* parameters, const plc_extras* extras,
                               plc_surface** surface);

/* ---- surface ---------------------------------------------------------------------------- */

PLC_API void plc_surface_destroy(plc_surface* surface);
PLC_API int64_t plc_surface_vertex_count(const plc_surface* surface);
PLC_API int64_t plc_surface_face_count(const plc_surface* surface);
/* xyz: 3 * vertex_count floats. Vertices are in the engine's canonical order. */
PLC_API void plc_surface_positions(const plc_surface* surface, plc_space space, float* xyz);
/* abc: 3 * face_count indices, counter-clockwise seen from outside in the given space. */
PLC_API void plc_surface_faces(const plc_surface* surface, plc_space space, uint32_t* abc);
/* xyz: 3 * vertex_count floats, unit normals, outward. */
PLC_API void plc_surface_normals(const plc_surface* surface, plc_space space, float* xyz);
/* 64-bit FNV-1a over, in this order: the number of vertices (u64), the bits of the positions in
 * the engine's mesh space (x, y, z of vertex 0, 1, ...: three u32 each), then each vertex's valence
 * (u32) and ring (u32 each, from its smallest neighbour on, counter-clockwise); little endian. */
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
PLC_API plc_status plc_surface_measure(plc_context* context, const plc_surface* surface,
                                       plc_space space, plc_measures* measures);

/* How the surface came to be, level by level. */
struct plc_level_report {
  size_t struct_size;
  int level;       /* h */
  int64_t dims[3]; /* of I_h, padding included */
  double unit;     /* U_h, mm */
  double delta;    /* the invariant of (1)-(3) in mesh units (voxels of I_0 by default) */
  double iso;      /* pi_I of this level, in the image's units */
  int64_t iterations;
  int64_t vertices; /* at the end of the level */
  int converged;    /* 0: the iteration cap ended it */
  double energy;    /* at the end */
  double speed;     /* of the fastest vertex at the end, in delta per time */
  double seconds_topology, seconds_normals, seconds_dynamics, seconds_total;
  int64_t creations, inversions, deletions, annular, axial, tetrahedra, refinements;
  int64_t deferred;                    /* operations that a limit put off to the next iteration */
  int64_t late_bubbles, late_cavities; /* started in parts and cavities that had been missed */
  double late_volume;                  /* of all of them as they started, mm3 */
  int64_t moves;  /* of single vertices; those that sleep are left out, in blocks of 16 */
  int64_t checks; /* of single vertices' constraints after a movement (3.6, slow vertices) */
};
/* 0 .. plc_surface_level_count - 1, from coarse to fine. */
PLC_API int plc_surface_level_count(const plc_surface* surface);
PLC_API plc_status plc_surface_level(const plc_surface* surface, int index,
                                     plc_level_report* report);
/* Seconds of everything before the evolution - range, window, pyramid, iso-values - and of the
 * evolution; the parameters as used, with everything that was derived filled in. */
PLC_API void plc_surface_seconds(const plc_surface* surface, double* pyramid, double* evolution);
/* Of the former, those of the pyramid's images alone. */
PLC_API double plc_surface_image_seconds(const plc_surface* surface);
PLC_API void plc_surface_parameters(const plc_surface* surface, plc_parameters* parameters);
/* Smallest and largest voxel of the input. */
PLC_API void plc_surface_input_range(const plc_surface* surface, double* low, double* high);

/* ---- checking any mesh ------------------------------------------------------------------ */

typedef struct plc_check {
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
} plc_check;

/* xyz: 3 * vertex_count finite values; abc: 3 * face_count indices below vertex_count. Predicates
 * are exact. PLC_INVALID_DATA where an index or a value is out of range; an invalid mesh is PLC_OK
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
 * values; INFINITY where no path leads. Paths cross borders nowhere and edges of any number of
 * faces. The time grows like vertex_count^1.5 on usual meshes; one thread. */
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

/* distance: one value per vertex of the first mesh, or NULL. summary may be NULL, else struct_size
 * must be set; NAN in it where the first mesh has no area (mean, rms) or no vertex (the others).
 * PLC_INVALID_DATA where the other mesh has no face. */
PLC_API plc_status plc_mesh_distance(plc_context* context, const double* xyz, int64_t vertex_count,
                                     const uint32_t* abc, int64_t face_count,
                                     const double* other_xyz, int64_t other_vertex_count,
                                     const uint32_t* other_abc, int64_t other_face_count,
                                     double* distance, plc_distances* summary);

#ifdef __cplusplus
}
#endif

#endif
