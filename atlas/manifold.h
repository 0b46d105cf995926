// The manifold that an atlas covers: a smooth n-dimensional surface in R^N whose points are named by m coordinates.
//
// symbol  name                  meaning
//   n     dimension             dimension of the manifold
//   N     ambient_dimension     dimension of the space that it lies in; distances are measured there
//   m     coordinate_dimension  how many coordinates name a point: m = N for an implicit surface F(x) = 0,
//                               m = n for a surface that is a graph over its parameters
//
// Equal points must have equal ambient points, whatever coordinates name them: an angle enters by its sine and cosine.
// So the atlas, which only looks at ambient points, never asks whether two coordinate vectors mean the same. Only
// the search does, when it unwraps a path; CoordinateSymmetry answers there.
//
// All of it is binary64 without claim: the atlas proposes, certify/ proves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace taut {

inline constexpr int kMaxDimension = 6;    ///< of a manifold: the pose space of a rigid body
inline constexpr int kMaxCoordinates = 8;  ///< that name a point

using TangentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDimension, 1>;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCoordinates, 1>;
using Lift = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxCoordinates, kMaxDimension>;

/// A point of the manifold and its tangent space.
struct Frame {
  Coordinates coordinates;  ///< m: names the point
  Eigen::VectorXd point;    ///< N: x
  Eigen::MatrixXd tangent;  ///< N x n: Phi, orthonormal columns
  Lift lift;                ///< m x n: first-order change of the coordinates per tangent coordinate

  /// u = Phi^T (x' - x): the ambient point x' in this frame's tangent space, n.
  [[nodiscard]] TangentVector tangent_coordinates(const Eigen::VectorXd& ambient_point) const {
    TangentVector u(tangent.cols());
    for (int k = 0; k < u.size(); ++k) u[k] = tangent.col(k).dot(ambient_point - point);
    return u;
  }
};

/// Which of its equivalent coordinate vectors a point is given by:
///   coordinates_j = ± base_j + pi * half_turns_j,
/// minus only for the second coordinate of a flip, when `flipped`. Exact, where a rounded sum would not be.
struct Image {
  std::array<int, kMaxCoordinates> half_turns{};
  bool flipped = false;
  bool operator==(const Image&) const = default;
};

/// Coordinates that mean the same point: angles modulo 2 pi, and tilt-and-torsion's (phi, theta) ~ (phi + pi, -theta).
struct CoordinateSymmetry {
  std::array<bool, kMaxCoordinates> periodic{};
  /// Indices of phi and theta; phi is periodic.
  std::optional<std::array<int, 2>> flip;

  /// The image of `base` that lies nearest to `near`; of several equally near ones, the unflipped.
  [[nodiscard]] Image nearest_image(const Coordinates& base, const Coordinates& near) const;
  /// The coordinates of an image, rounded.
  [[nodiscard]] Coordinates apply(const Coordinates& base, const Image& image) const;
};

class Manifold {
 public:
  virtual ~Manifold() = default;

  [[nodiscard]] virtual int dimension() const = 0;
  [[nodiscard]] virtual int ambient_dimension() const = 0;
  [[nodiscard]] virtual int coordinate_dimension() const = 0;
  /// Default: different coordinates are different points.
  [[nodiscard]] virtual CoordinateSymmetry symmetry() const { return {}; }

  /// Point and tangent space at the given coordinates, which the frame repeats bit for bit; for an implicit surface
  /// they are those of a point on it. False, and `frame` is of no use, outside the domain.
  /// `frame` is passed in so that its memory is used again; implementations should write into it in place. The atlas
  /// looks up neighbours by the first NeighbourIndex::kDimension ambient coordinates: put those first that tell
  /// points apart best.
  [[nodiscard]] virtual bool frame_at(const Coordinates& coordinates, Frame& frame) const = 0;

  /// Coordinates of the manifold's point over tangent coordinates u. False where there is none (Newton failed).
  /// Default: coordinates + lift u, which is right to first order and is all that a graph over its parameters needs.
  [[nodiscard]] virtual bool project(const Frame& frame, const TangentVector& u, Coordinates& coordinates) const {
    coordinates = frame.coordinates + frame.lift * u;
    return true;
  }

 protected:
  Manifold() = default;
  Manifold(const Manifold&) = default;
  Manifold& operator=(const Manifold&) = default;
};

}  // namespace taut
