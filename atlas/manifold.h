// SPDX-License-Identifier: GPL-3.0-or-later
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
#include <cstddef>
#include <optional>
#include <vector>

namespace taut {

inline constexpr int kMaxDimension = 6;    ///< of a manifold: the pose space of a rigid body
inline constexpr int kMaxCoordinates = 8;  ///< that name a point

using TangentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxDimension, 1>;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCoordinates, 1>;
using AmbientPoint = Eigen::Ref<const Eigen::VectorXd>;

/// A point of the manifold and its tangent space. All numbers lie in one block of memory, since atlases hold many frames.
class Frame {
 public:
  /// Sets the sizes m, N and n; what the frame held is lost. Memory is used again where there is enough.
  void resize(Eigen::Index coordinates, Eigen::Index ambient, Eigen::Index dimension) {
    m_ = coordinates;
    ambient_ = ambient;
    n_ = dimension;
    values_.resize(static_cast<std::size_t>((m_ + ambient_) * (1 + n_)));
  }
  [[nodiscard]] Eigen::Index dimension() const { return n_; }

  /// m: names the point.
  [[nodiscard]] auto coordinates() const { return Eigen::Map<const Eigen::VectorXd>(values_.data(), m_); }
  [[nodiscard]] auto coordinates() { return Eigen::Map<Eigen::VectorXd>(values_.data(), m_); }
  /// N: x.
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
    coordinates = frame.coordinates() + frame.lift() * u;
    return true;
  }

 protected:
  Manifold() = default;
  Manifold(const Manifold&) = default;
  Manifold& operator=(const Manifold&) = default;
};

}  // namespace taut
