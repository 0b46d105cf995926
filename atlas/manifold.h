// SPDX-License-Identifier: GPL-3.0-or-later
// The manifold that an atlas covers: a smooth n-dimensional surface in R^N whose points are named by m coordinates.
//
// symbol  name                  meaning
//   n     dimension             dimension of the manifold
//   N     ambient_dimension     dimension of the space around it, in which distances are measured
//   m     coordinate_dimension  how many coordinates name a point: m = N for an implicit surface F(x) = 0,
//                               m = n for a surface that is a graph over its parameters
//
// Coordinate vectors that name the same point must have equal ambient points: an angle enters by its sine and cosine.
// The atlas looks at ambient points only, so it never compares coordinate vectors. Only the search does, when it
// unwraps a path, with CoordinateSymmetry.
//
// Everything is computed in binary64 and nothing is guaranteed: the atlas proposes, certify/ proves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace taut {

inline constexpr int kMaxDimension = 6;    ///< of a manifold: the pose space of a rigid body has six
inline constexpr int kMaxCoordinates = 8;  ///< of a point

using TangentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDimension, 1>;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCoordinates, 1>;
using AmbientPoint = Eigen::Ref<const Eigen::VectorXd>;

/// A point of the manifold and its tangent space. All numbers lie in one block of memory, since atlases hold many
/// frames.
class Frame {
 public:
  /// Sets the sizes m, N and n. The content is lost; memory is reused if there is enough.
  void resize(Eigen::Index coordinates, Eigen::Index ambient, Eigen::Index dimension) {
    m_ = coordinates;
    ambient_ = ambient;
    n_ = dimension;
    values_.resize(static_cast<std::size_t>((m_ + ambient_) * (1 + n_)));
  }
  [[nodiscard]] Eigen::Index dimension() const { return n_; }

  /// m: the coordinates that name the point.
  [[nodiscard]] auto coordinates() const { return Eigen::Map<const Eigen::VectorXd>(values_.data(), m_); }
  [[nodiscard]] auto coordinates() { return Eigen::Map<Eigen::VectorXd>(values_.data(), m_); }
  /// N: the ambient point x.
  [[nodiscard]] auto point() const { return Eigen::Map<const Eigen::VectorXd>(values_.data() + m_, ambient_); }
  [[nodiscard]] auto point() { return Eigen::Map<Eigen::VectorXd>(values_.data() + m_, ambient_); }
  /// N x n: Phi, orthonormal columns.
  [[nodiscard]] auto tangent() const { return Eigen::Map<const Eigen::MatrixXd>(tangent_data(), ambient_, n_); }
  [[nodiscard]] auto tangent() { return Eigen::Map<Eigen::MatrixXd>(tangent_data(), ambient_, n_); }
  /// m x n: first-order change of the coordinates per tangent coordinate.
  [[nodiscard]] auto lift() const { return Eigen::Map<const Eigen::MatrixXd>(tangent_data() + ambient_ * n_, m_, n_); }
  [[nodiscard]] auto lift() { return Eigen::Map<Eigen::MatrixXd>(tangent_data() + ambient_ * n_, m_, n_); }

  /// u = Phi^T (x' - x): the ambient point x' in this frame's tangent space, n.
  [[nodiscard]] TangentVector tangent_coordinates(const AmbientPoint& ambient_point) const {
    return tangent_part(ambient_point - point());
  }
  /// Phi^T d of an ambient vector d, n.
  [[nodiscard]] TangentVector tangent_part(const AmbientPoint& vector) const {
    TangentVector u(n_);
    for (Eigen::Index k = 0; k < n_; ++k) u[k] = tangent().col(k).dot(vector);
    return u;
  }

 private:
  [[nodiscard]] const double* tangent_data() const { return values_.data() + m_ + ambient_; }
  [[nodiscard]] double* tangent_data() { return values_.data() + m_ + ambient_; }

  Eigen::Index m_ = 0;
  Eigen::Index ambient_ = 0;
  Eigen::Index n_ = 0;
  std::vector<double> values_;  ///< coordinates, point, tangent, lift; matrices by columns
};

/// One of the equivalent coordinate vectors of a point:
///   coordinates_j = ± base_j + pi * half_turns_j,
/// with minus only for the second coordinate of a flip, if `flipped`. This is exact; the sum in binary64 is rounded.
struct Image {
  std::array<int, kMaxCoordinates> half_turns{};
  bool flipped = false;
  bool operator==(const Image&) const = default;
};

/// Which coordinates name the same point: angles are modulo 2 pi, and in tilt-and-torsion angles (phi, theta) and
/// (phi + pi, -theta) are the same.
struct CoordinateSymmetry {
  std::array<bool, kMaxCoordinates> periodic{};
  /// Indices of phi and theta; phi is periodic.
  std::optional<std::array<int, 2>> flip;

  /// The image of `base` nearest to `near`; if a flipped and an unflipped one are equally near, the unflipped.
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
  /// By default, different coordinates are different points.
  [[nodiscard]] virtual CoordinateSymmetry symmetry() const { return {}; }

  /// Computes the point and the tangent space at these coordinates, which the frame repeats bit for bit; on an implicit
  /// surface they are those of a point near by that is on the surface. Returns false outside the domain; `frame` is
  /// undefined then. `frame` is passed in so that its memory is reused; implementations should write into it in place.
  /// The atlas looks up neighbours by the first NeighbourIndex::kDimension ambient coordinates, so the ones that
  /// distinguish points best should come first.
  [[nodiscard]] virtual bool frame_at(const Coordinates& coordinates, Frame& frame) const = 0;

  /// Computes the coordinates of the manifold's point over tangent coordinates u. Returns false if there is none
  /// (Newton's method failed). The default is coordinates + lift u, which is right to first order; a graph over its
  /// parameters needs no more.
  [[nodiscard]] virtual bool project(const Frame& frame, const TangentVector& u, Coordinates& coordinates) const {
    coordinates = frame.coordinates() + frame.lift() * u;
    return true;
  }

 protected:
  Manifold() = default;
  Manifold(const Manifold&) = default;
  Manifold& operator=(const Manifold&) = default;
};

}  // namespace taut
