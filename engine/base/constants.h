// Every constant of the paper and of our closing of its gaps, once, with its source and what
// changing it does.
#pragma once
#include <cstddef>
#include <cstdint>

namespace plc {

// ---- geometry of the mesh (3.2) -------------------------------------------------------------

// (2): no edge as long as 2.5 delta. Below 2 a creation would make edges that violate (1).
inline constexpr float kMaxEdge = 2.5F;
// (3): non-neighbours are at least 2.5 / sqrt 3 delta apart: the longest distance between a vertex
// and the nearest corner of the facet that it goes through. Smaller lets surfaces cross unseen.
inline constexpr float kMinApart = 1.4433757F;
// Each refinement divides the edge lengths by sqrt 3 (3.4).
inline constexpr double kRefinement = 1.7320508075688772;
// U_h / delta_h, within [1, 2.5 / sqrt 3] by (14). Larger means a finer mesh for the same image.
inline constexpr double kUnitPerDelta = 1.2;
// Where the mesh lives in millimetres (method 1 of 4.4), cubes of U_h in a voxel, at most: up to
// 1 : 1 : 8 the mesh is as fine as the paper has it.
inline constexpr double kCubesPerVoxel = 8;

// Coordinates lie within this of the origin of mesh space: further out floats do not tell
// neighbouring voxels apart, and cells of the hash would be beyond their numbers.
inline constexpr float kReach = 16777216;

// ---- adaptive meshes (pyramid/size_field.h) ---------------------------------------------------

// Edges are longer than (2) has them by no more than this, where a vertex has gone to a place of
// another size since it was looked at.
inline constexpr float kSizedStretch = 1.05F;
// alpha_c of an adaptive mesh, as a part of the model's: what (5) smooths of a thin part pulls its
// rim in. Images are 0.115 (Iguana), 0.187 (bonsai) and 0.257 voxels (aorta) from their
// iso-surfaces at 0.175; 0.102, 0.156 and 0.230 at 0.09; 0.099, 0.144 and 0.224 at 0.06; 0.098,
// 0.131 and 0.218 at 0.03, where a third more sites are frozen.
inline constexpr float kSizedCurvature = 0.06F;
// The image is sampled this part of the Laplacian off a vertex: at the mean of its facets, not at
// the corner. Facets of edges e on a ball of radius R lie e^2 / 8 R inside its corners in the mean,
// and Laplacians are e^2 / 2 R.
inline constexpr float kFacets = 0.25F;
// Of the image's value for a vertex, the most that the mean over the middles of its edges has:
// noise in it is less. Alone it would not see a vertex that stands out between its neighbours.
inline constexpr float kStar = 0.75F;
// Smoothing that comes to it, as a part of the model's alpha_c, for the variance of places by noise
// (SizeField::noise(), squared, up to kMostNoise): as noise and bending weigh against each other in
// the likeliest surface. A ball of blur 2 and noise 0.1 is 0.160 voxels off at 0, 0.086 at 4, 0.080
// at 6, 0.073 at 12; a rod of 3 voxels in that noise 0.128, 0.148, 0.167 and 0.202 (all with 0.175
// above).
inline constexpr float kNoiseCurvature = 6;
inline constexpr float kMostNoise = 1;

// How far to both sides of a vertex its compliance (guided_stage.h) looks, in delta.
inline constexpr float kComplianceReach = 0.25F;
// Damping and time step of an adaptive mesh, as parts of the model's: stiffnesses are about 1
// there, or less, and the model's damping lets such vertices swing. Without compliances, damped and
// stepped as the model has it, Iguana, bonsai and a head CT rest after 28, 28 and 20 iterations,
// with them after 19, 19 and 16, as near within 0.002 voxels.
inline constexpr float kComplyingDamping = 2.8F;
inline constexpr float kComplyingStep = 1.4F;

// ---- slow vertices (3.6) --------------------------------------------------------------------

// The constraints of a vertex are checked when it has moved 0.2 delta since its last check, or
// after 50 iterations. The paper makes the period linear in the speed, which lets a vertex travel
// 1.28 delta unchecked. On a head CT, coarse to fine, 0.1 takes a quarter longer, and 0.3 a tenth:
// more is at risk (risk.h).
inline constexpr float kCheckPath = 0.2F;
inline constexpr int kCheckPeriod = 50;

// Pairs that violate (3) which are listed for one vertex at a time. Where vertices are delta apart
// there are no more; a start that is far finer than delta has thousands, whose list would not fit
// into memory. The others are seen when these have been resolved.
inline constexpr size_t kMostNear = 256;

// ---- sleep (sleep.h) ------------------------------------------------------------------------

// The calm speed, as a part of the speed that every vertex would have at the energy epsilon,
// sqrt(2 epsilon) delta per time. More leaves less awake but loses area: coarse to fine the main
// part of a head CT was 0.93 % smaller than that of a direct run, and 1.04 % at 0.65.
inline constexpr double kCalmSpeed = 0.5;
inline constexpr float kCalmSlide = 10;
inline constexpr uint8_t kCalmPeriod = 8;
// A vertex that has moved so far along its normal, in delta, wakes its neighbours.
inline constexpr float kWakeMove = 0.05F;
// A level ends only when it has been calm for so many iterations with all awake, and is not tried
// again sooner.
inline constexpr int kConfirmIterations = 6;
inline constexpr int kConfirmPause = 20;

// ---- turns (mesh/turns.h) --------------------------------------------------------------------

// Of a vertex that may move as far as any. Coarse to fine, 20 changes the area of a head CT by 2 in
// 10^5.
inline constexpr uint32_t kFreeTurns = 20;
// With more turns a vertex keeps no velocity between iterations: it goes where its forces lead it
// and stays there. Without, a level of Iguana or of ch2bet ends with three to ten times as many
// frozen sites and half as many iterations more; at 6 it ends with fronts that creep: surfaces are
// farther from what they approach by 3 to 6 %.
inline constexpr uint32_t kSwingingTurns = 10;
// Slower movements than this do not turn a vertex, in speeds that every vertex would have at the
// energy epsilon. Less freezes what only trembles: at 1, and 5 turns for a transformation, a direct
// run of a head CT whose turns counted from its start ended with 368 handles instead of 86.
inline constexpr double kTurnSpeed = 2;
inline constexpr uint32_t kTransformationTurns = 3;
// A surface has arrived (motion/travel.h) when so much less than this share of its vertices goes to
// one side than to the other, over about so many iterations. At 0.05 direct runs of a phantom of
// vessels and of a head CT end with 55 and 8 components, 22 and 58 handles; at 0.01 with 59 and 8,
// 24 and 59, after a few more iterations.
inline constexpr double kArrived = 0.05;
inline constexpr double kTravelMemory = 8;

// ---- spatial hash ---------------------------------------------------------------------------

// Size of a cell, in delta. What is around a group of vertices is fetched from a box 6 to 10 wide:
// smaller cells cost more rows, most of them empty. With every vertex of a head CT due a look took
// 364 ns at 2, 327 at 3, 283 at 4, before other parts of it were made faster.
inline constexpr float kHashCell = 4.0F;
// Built anew when more than one in so many vertices has been entered a second time. Those entries
// are walked one by one: at 4 they were a quarter of what it takes to collect what is around a
// vertex. Iguana's start from its iso-surface takes 8 % longer where none is built within a pass.
inline constexpr uint32_t kHashInsertions = 32;
// How far a vertex may be from where it was entered, in delta: what it moves between two checks,
// and room for the rounding of each movement.
inline constexpr float kHashSlack = 1.05F * kCheckPath;

// ---- resolution (figure 9) ------------------------------------------------------------------

// What makes the paper's loop finite: what is left over waits for the next iteration.
inline constexpr int kMaxOperationsPerVertex = 40;
inline constexpr int kMaxAxialPasses = 10;
// Rounds of one resolution pass: a safety net, as no pass was seen to take more than 12.
inline constexpr int kMaxRounds = 200;
// Checks of all vertices at the end of a level: no level was seen to take more than 3.
inline constexpr int kCheckPasses = 10;

// ---- transformations ------------------------------------------------------------------------

// Intermediary vertices of an axial transformation lie at this part of the way to the neighbour.
// 1/2 costs 40 % more deletions and 55 % more axial transformations.
inline constexpr float kAxialReach = 0.75F;
// Facing sheets only: pairs whose normals agree more than this are one sheet seen edge-on.
inline constexpr float kAxialMaxNormalDot = 0.5F;
// Each copy of a cut cycle moves this part of the way to its neighbours outside the cycle; without
// it the copies, which coincide, collide at once.
inline constexpr float kAnnularRetreat = 0.55F;
// A freshly cut pair is exempt from axial transformations for this long, while it does not
// approach. A blind exemption lets sheets cross.
inline constexpr uint32_t kCutExemption = 5;
// In an adaptive mesh on the full image nothing is cut or joined by (3) before this iteration: it
// may start from the iso-surface, where sheets are as near as the image has them, and forces part
// what they can. From the first iteration on, and before it, thin parts are torn farther: of eight
// images the mean distance to what comes out is larger by up to 5 %, and more sites freeze.
inline constexpr uint32_t kFirstPairs = 9;

// The embedding guard looks for faces with a corner within this of the new ones, in delta: a point
// of a triangle is within 1 / sqrt 3 of its longest edge of a corner, so that faces with edges up
// to 3.46 delta are found. Edges reach 2.5 delta by (2) and 0.8 more by one movement of both ends.
inline constexpr float kFaceReach = 2.0F;

// The motion guard looks for other parts of the surface within this, in delta: (1/2 + 1/sqrt 3) of
// the longest edge of (2), and twice kCheckPath for what vertices move between two checks.
inline constexpr float kRiskReach = 2.7F + 2 * kCheckPath;
// ... whose normals are turned against a vertex's own by more than this cosine. Higher tests more
// faces; from 0.5 down to 0.2 no run was seen to differ.
inline constexpr float kRiskDot = 0.3F;
// ... unless a plane lies between the faces of both with this much room, in delta: twice what a
// vertex moves between two checks.
inline constexpr float kRiskGap = 2 * kCheckPath;

// Components up to this size are watched for turning inside out.
inline constexpr uint32_t kTinyComponent = 40;
// ... and deleted when their volume falls under this (in delta^3) or changes sign.
inline constexpr double kTinyVolume = 0.5;

// ---- late bubbles ---------------------------------------------------------------------------

// Radius of the smallest bubble, in delta: an icosahedron of it has edges of 1.2 delta. What holds
// no such ball has sheets that are nearer than (3) allows.
inline constexpr float kSmallestBubble = 1.15F;
// Sheets of a place that are thinner, in delta, start without a bubble where the mesh is uniform:
// most of it would be cut away by (3) again, operation by operation. From 1.44, which is (3),
// to 1.8 mean distances to the results of head CT, Iguana and bonsai are those of whole places
// within 3 %; at 2.3 that of the head CT is a third larger.
inline constexpr float kThinSheet = 1.8F;
// Room between a bubble and the vertices of the rest, in delta: (3) and a little. No point of a
// face is this far from its corners.
inline constexpr float kBubbleGap = 1.5F;
// The image that an adaptive mesh is drawn by holds values so far beyond its window, in windows:
// between clipped voxels the iso-surface lies elsewhere, by up to a third of a voxel where the
// image is steep.
inline constexpr float kBeyondWindow = 4;
// Where a place gets a bubble, and where the surface bends though the image does not, sizes of an
// adaptive mesh are at most this, in delta: the border of a hole in a plate is nothing of the
// image's, by which its edges would be long.
inline constexpr float kLateSize = 1.25F;
// ... and this where the full image is thinner than kThin delta along an axis: of four images mean
// distances to what comes out are smaller by 4 to 18 %, with 4 to 17 % more vertices. On coarser
// levels it would be no nearer, but slower. Sizes are whole thirty-seconds.
inline constexpr float kThinSize = 0.65625F;
inline constexpr float kThin = 1;
// Noise that moves the iso-surface by more than this, standard deviation in delta, makes thin parts
// and rims itself: what a mesh starts from is not looked at for them. At 0.48 a ball in a tenth of
// noise would be 0.071 voxels off with 2,331 vertices, not 0.061 with 587; below it a plate of 1.5
// voxels in half of that noise is 0.120 off, not 0.126.
inline constexpr float kThinNoise = 0.35F;
// Cosine of 60 degrees, by which a face turns from the normal at its corner where the surface
// bends.
inline constexpr float kFoldCosine = 0.5F;
// Places of so many voxels get a bubble in an adaptive mesh, however thin they are; parts of the
// object of which so many are not joined by faces get none, and they and smaller cavities are left
// out of the iso-surface that it starts from.
inline constexpr int64_t kPlaceVoxels = 27;
// Noise that moves the iso-surface by more than this, standard deviation in delta, makes so much of
// it that where it lies is told by the level above I_0: an adaptive mesh is recovered from there,
// at the iso-value of I_0, and its late bubbles leave out specks. Balls, a chain and a shell come
// out 1.2 to 1.9 times as near to what is true as from the iso-surface of I_0, in a quarter to half
// of the time (perf/results/distances.md); with 1.5 thin vessels come out farther, with 1 plates.
inline constexpr float kNoisy = 2;
// What still moves is not missed yet: a surface is searched when its energy is below this many
// epsilon.
inline constexpr double kLateEnergy = 10;
// What a vertex counts in the energy at most, in epsilon, where an adaptive mesh starts from the
// iso-surface of the full image: all is where it belongs then, and what still moves draws back from
// parts thinner than it can hold, fast and for long. Of an abdominal CT a hundredth of the vertices
// had nine tenths of the energy for 100 iterations, which ended no nearer to the iso-surface.
// At 30 Iguana, bonsai and dicom_ct take 23, 23 and 22 iterations, at 10 19 each, as near within
// 0.001 voxels.
// Surfaces that come from farther away end when their fronts do.
inline constexpr double kMostEnergy = 10;
// Iterations before an adaptive mesh is searched at first: the energy is near 0 from rest.
inline constexpr int kEarlySearch = 5;
// Times that I_0 is searched again after it has converged: what a bubble grows into may hide more.
inline constexpr int kLateRounds = 2;

// ---- dynamics (3.5, 5.1) --------------------------------------------------------------------

// RK4 is stable on the imaginary axis up to 2.83 and damped modes need less: dt sqrt(k / m) is
// kept below this, k the stiffest mode of the forces.
inline constexpr double kStableFrequency = 2.2;
// ... and on the real axis up to 2.79: dt gamma / m is kept below this. Beyond it speeds grow from
// step to step, whatever the forces.
inline constexpr double kStableDecay = 2.5;
// The energy is near 0 from rest, before anything has moved: a level runs at least this long, and
// has converged when its energy was calm this many times in a row.
inline constexpr int kMinIterations = 20;
// ... but for rounds of an adaptive mesh after the first: most of it has moved before.
inline constexpr int kMinLateIterations = 10;
// ... of a round after all has come to rest, in which only what is new is awake: with 10, mean
// distances of eight images are the same to 0.001 voxels, 95 % of them smaller by 1.3 % at most.
inline constexpr int kMinSettledIterations = 6;
inline constexpr int kCalmIterations = 3;

// ---- image ----------------------------------------------------------------------------------

// Voxels of outside value around the image: what the border cuts comes out closed.
inline constexpr int kPadVoxels = 6;

// ---- schedule -------------------------------------------------------------------------------

// Vertices per task: large enough to pay for a task, a multiple of the ring block.
inline constexpr uint32_t kGrain = 1024;

}  // namespace plc
