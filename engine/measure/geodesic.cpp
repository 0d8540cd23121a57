#include "engine/measure/geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "engine/base/double3.h"
#include "engine/measure/edge_ring.h"
#include "engine/measure/mesh_topology.h"
#include "engine/measure/vertex_corners.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Intervals shorter than this part of their edge are dropped: what they would reach is reached by
// the ends of their neighbours, with the square of this as the error.
constexpr double kNarrow = 1e-13;
// Two windows of the same unfolded vertex meet in the path to a corner; which of them is nearer,
// and on which side its path is, is rounding then. Crossings nearer to each other than this part of
// the edge are not told apart: both windows go on to both sides.
constexpr double kSame = 1e-8;

// Chen & Han: the windows of all paths through n faces are O(n) for each number of faces that they
// have come through, and none comes through more than n. Where lengths differ so much that the
// short ones are lost in sums, which of two paths is nearer is rounding, and nothing else ends
// their number: so many times n^2 are followed.
constexpr double kCrossings = 8;

// Paths that come over the edge opposite to `corner` into its face. x runs along the edge from the
// corner's next to its previous one, y into the face.
struct Window {
  double low, high;     // x of the interval
  double x, depth;      // the unfolded vertex is at (x, -depth)
  double sigma;         // the distance of that vertex
  uint32_t corner, by;  // by: that vertex
  uint32_t faces;       // that the paths have come through since they left it
};

// Squares neither over- nor underflow within the coordinates that are allowed.
double hypotenuse(double a, double b) {
  return std::sqrt(a * a + b * b);
}

double distance_at(const Window& w, double x) {
  return w.sigma + hypotenuse(x - w.x, w.depth);
}

// A face with the window's edge from (0, 0) to (length, 0) and the apex at (x, y), y >= 0.
struct Frame {
  double length, x, y;
  double left() const { return hypotenuse(x, y); }            // the edge from 0 to the apex
  double right() const { return hypotenuse(length - x, y); }  // from the other end
};

// The window as it looks in the mirror that swaps the ends of its edge.
Window mirrored(const Window& w, double length) {
  return {length - w.high, length - w.low, length - w.x, w.depth, w.sigma, w.corner, w.by, w.faces};
}
Frame mirrored(const Frame& f) {
  return {f.length, f.length - f.x, f.y};
}

class Propagation {
 public:
  Propagation(const MeshArrays& mesh, const Executor& executor)
      : mesh_(mesh),
        crossings_left_(kCrossings * static_cast<double>(mesh.face_count) *
                        static_cast<double>(mesh.face_count)),
        distance_(mesh.vertex_count, kInfinity),
        corners_(mesh.abc, mesh.face_count, mesh.vertex_count),
        edges_(mesh.abc, mesh.face_count, mesh.vertex_count, executor),
        bends_(bending_vertices(mesh, corners_, edges_)),
        best_(3 * mesh.face_count, Best{kInfinity, 0}) {}

  const Vector<double>& run(uint32_t source) {
    bends_[source] = 1;
    reach(source, 0);
    while (!queue_.empty()) {
      const Event event = queue_.top();
      queue_.pop();
      if (!event.is_window) {
        if (event.key <= distance_[event.id]) spread(event.id);
        continue;
      }
      const Window window = windows_[event.id];
      free_.push_back(event.id);
      if (crossings_left_-- > 0) cross_face(window);
    }
    return distance_;
  }

 private:
  struct Event {
    double key;  // no path of it is shorter
    uint32_t id;
    bool is_window;
    bool operator<(const Event& other) const {  // the least comes first
      if (key != other.key) return key > other.key;
      if (is_window != other.is_window) return is_window;
      return id > other.id;
    }
  };
  // The nearest window that covers a corner from the opposite edge, and where its path to the
  // corner crosses that.
  struct Best {
    double distance, x;
  };

  const double* point(uint32_t corner) const { return mesh_.corner(corner); }
  double edge_length(uint32_t c, uint32_t d) const {
    return length(difference(point(c), point(d)));
  }

  void reach(uint32_t vertex, double distance) {
    if (!(distance < distance_[vertex])) return;
    distance_[vertex] = distance;
    if (bends_[vertex] != 0) queue_.push({distance, vertex, false});
  }

  // Straight paths from a vertex over the faces around it.
  void spread(uint32_t vertex) {
    const double sigma = distance_[vertex];
    for (const uint32_t c : corners_.of(vertex)) {
      const uint32_t next = next_corner(c), previous = previous_corner(c);
      reach(mesh_.abc[next], sigma + edge_length(c, next));
      reach(mesh_.abc[previous], sigma + edge_length(c, previous));
      const Frame f = frame_of(c);
      if (f.length > 0) emit({0, f.length, f.x, f.y, sigma, c, vertex, 1}, f.length);
    }
  }

  Frame frame_of(uint32_t corner) const {
    const double* a = point(next_corner(corner));
    const Double3 along = difference(point(previous_corner(corner)), a);
    const Double3 up = difference(point(corner), a);
    const double edge = length(along);
    return {edge, dot(up, along) / edge, length(cross(along, up)) / edge};
  }

  // The window, which left the face of its corner over the opposite edge, into the faces across.
  void emit(const Window& w, double length) {
    if (!(w.depth > 0) || !(w.high - w.low > kNarrow * length)) return;
    if (is_beaten(w, length)) return;
    const uint32_t from = mesh_.abc[next_corner(w.corner)];
    for (uint32_t o = edges_.across(w.corner); o != w.corner; o = edges_.across(o)) {
      Window out = mesh_.abc[next_corner(o)] == from ? w : mirrored(w, length);
      out.corner = o;
      push(out);
    }
  }

  // Whether each path of the window is longer than one along its edge from one of the ends.
  bool is_beaten(const Window& w, double length) const {
    return distance_[mesh_.abc[next_corner(w.corner)]] + w.high < distance_at(w, w.high) ||
           distance_[mesh_.abc[previous_corner(w.corner)]] + (length - w.low) <
               distance_at(w, w.low);
  }

  void push(const Window& w) {
    uint32_t id = 0;
    if (free_.empty()) {
      id = static_cast<uint32_t>(windows_.size());
      windows_.push_back(w);
    } else {
      id = free_.back();
      free_.pop_back();
      windows_[id] = w;
    }
    queue_.push({distance_at(w, std::clamp(w.x, w.low, w.high)), id, true});
  }

  // On from the edge to the apex and to the edges left and right of it.
  void cross_face(const Window& w) {
    if (w.sigma > distance_[w.by]) return;  // a shorter path to that vertex was found since
    const Frame f = frame_of(w.corner);
    if (is_beaten(w, f.length)) return;
    // A shortest path comes through no face twice. Where lengths differ so much that the short ones
    // are lost in sums, nothing else ends a path that goes round and round a vertex.
    if (w.faces >= mesh_.face_count) return;
    // Where the straight path to the apex crosses the edge, and the nearest place of the window.
    const double apex = w.x + (f.x - w.x) * (w.depth / (f.y + w.depth));
    const double through = std::clamp(apex, w.low, w.high);
    const bool covers = w.low < apex && apex < w.high;
    const double distance = covers ? w.sigma + hypotenuse(f.x - w.x, f.y + w.depth)
                                   : distance_at(w, through) + hypotenuse(f.x - through, f.y);
    reach(mesh_.abc[w.corner], distance);
    bool left = w.low < apex, right = apex < w.high;
    // Paths of a farther window cross the path of the nearest one before they come to its far side.
    // Not so at an edge of more faces, over which the two may come from different ones.
    if (covers && edges_.across(edges_.across(w.corner)) == w.corner) {
      Best& best = best_[w.corner];
      if (distance < best.distance) {
        best = {distance, apex};
      } else {
        left = apex <= best.x + kSame * f.length;
        right = apex >= best.x - kSame * f.length;
      }
    }
    if (left) turn_left(w, f, through, false);
    if (right) {
      const double other = f.length - through;
      turn_left(mirrored(w, f.length), mirrored(f), other, true);
    }
  }

  // On to the edge from (0, 0) to the apex; `through` is where the part that goes there ends. In
  // the mirror that is the right side of the face.
  void turn_left(const Window& w, const Frame& f, double through, bool in_mirror) {
    const double edge = f.left();
    if (!(edge > 0)) return;
    const auto part = [&](double x) {  // of the edge, where the path over x meets it
      const double across = f.x * w.depth - f.y * (x - w.x);
      return across > 0 ? std::clamp(w.depth * x / across, 0.0, 1.0) : 1.0;
    };
    const bool to_apex = through < w.high;
    const double first = part(w.low), last = to_apex ? 1.0 : part(w.high);
    // A path from the edge's far end to the near end of the interval crosses all paths of it.
    const uint32_t far = in_mirror ? next_corner(w.corner) : previous_corner(w.corner);
    const double meet_x = first * f.x, meet_y = first * f.y;
    if (distance_[mesh_.abc[far]] + hypotenuse(f.length - meet_x, meet_y) <
        w.sigma + hypotenuse(meet_x - w.x, meet_y + w.depth)) {
      return;
    }
    // From (0, 0) on; the corner opposite to the edge is `far`, and its next one the apex, or in
    // the mirror the end at (0, 0).
    const Window out{first * edge,
                     last * edge,
                     (w.x * f.x - w.depth * f.y) / edge,
                     std::max(0.0, (w.depth * f.x + w.x * f.y) / edge),
                     w.sigma,
                     far,
                     w.by,
                     w.faces + 1};
    emit(in_mirror ? out : mirrored(out, edge), edge);
  }

  MeshArrays mesh_;
  double crossings_left_;
  Vector<double> distance_;
  VertexCorners corners_;
  EdgeRings edges_;
  Vector<uint8_t> bends_;  // vertices that shortest paths may bend at
  Vector<Best> best_;      // per corner
  std::priority_queue<Event> queue_;
  Vector<Window> windows_;
  Vector<uint32_t> free_;  // unused places of windows_
};

}  // namespace

void geodesic_distances(const MeshArrays& mesh, uint32_t source, const Executor& executor,
                        double* distance) {
  Propagation propagation(mesh, executor);
  const Vector<double>& distances = propagation.run(source);
  std::copy(distances.begin(), distances.end(), distance);
}

size_t nearest_vertex(const MeshArrays& mesh, const double* point) {
  size_t nearest = mesh.vertex_count;
  double least = kInfinity;
  for (size_t c = 0; c < 3 * mesh.face_count; ++c) {
    const Double3 off = difference(mesh.corner(c), point);
    const double squared = dot(off, off);
    if (squared > least || (squared == least && mesh.abc[c] >= nearest)) continue;
    least = squared;
    nearest = mesh.abc[c];
  }
  return nearest;
}

}  // namespace plc
