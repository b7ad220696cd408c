// SPDX-License-Identifier: MIT
#pragma once

/// @file The solver's deformation role, filled by the model that the command line names, and the display mesh
/// that it moves.

#include <palpate/elasticity/concept.hpp>
#include <palpate/elasticity/isotropic.hpp>
#include <palpate/law/map/duffing_map.hpp>

#include <chrono>
#include <memory>

#include "body.hpp"
#include "tools.hpp"

namespace touch {

inline constexpr std::size_t max_regions = 4;

/// Silicone rubber of Shore hardness 00-30: E is the 100 % modulus of its maker's data sheet, 10 psi
/// (Smooth-On, Ecoflex 00-30). The paper's own E was lost in the scan.
inline const palpate::IsotropicElasticity<S> rubber({.E = 69e3, .nu = 0.5});

/// A deformation model chosen at run time; none: the shape stays the undeformed one.
class Shape {
 public:
  using Scalar = S;
  using Contacts = std::span<const palpate::ContactState<S>>;
  using Buffer = palpate::VertexBuffer<S>;
  static constexpr bool active = true;

  class Model {
   public:
    Model() = default;
    Model& operator=(const Model&) = delete;
    virtual ~Model() = default;
    virtual palpate::Moved<S> write(Contacts contacts, const Buffer& out) noexcept = 0;
    virtual void write_rest(const Buffer& out) noexcept = 0;
    [[nodiscard]] virtual std::unique_ptr<Model> clone() const = 0;

   protected:
    Model(const Model&) = default;
  };

  Shape() = default;
  explicit Shape(std::unique_ptr<Model> model) : model_(std::move(model)) {}
  Shape(const Shape& other) : model_(other.model_ ? other.model_->clone() : nullptr) {}
  Shape(Shape&&) = default;
  Shape& operator=(const Shape&) = delete;
  Shape& operator=(Shape&&) = default;
  ~Shape() = default;

  [[nodiscard]] bool exists() const noexcept { return model_ != nullptr; }

  template <palpate::Real T>
  palpate::Moved<S> write(Contacts contacts, const palpate::VertexBuffer<T>& out) noexcept {
    static_assert(std::same_as<T, S>, "the example draws in double");
    return model_ ? model_->write(contacts, out) : palpate::Moved<S>{};
  }
  template <palpate::Real T>
  void write_rest(const palpate::VertexBuffer<T>& out) noexcept {
    static_assert(std::same_as<T, S>, "the example draws in double");
    if (model_) model_->write_rest(out);
  }

 private:
  std::unique_ptr<Model> model_;
};
static_assert(palpate::DeformationModel<Shape>);

/// Any of the library's models as a `Shape`.
template <palpate::DeformationModel D>
[[nodiscard]] Shape shape_of(D model) {
  struct Of final : Shape::Model {
    D model;
    explicit Of(D from) : model(std::move(from)) {}
    palpate::Moved<S> write(Shape::Contacts contacts, const Shape::Buffer& out) noexcept override {
      return model.write(contacts, out);
    }
    void write_rest(const Shape::Buffer& out) noexcept override { model.write_rest(out); }
    std::unique_ptr<Shape::Model> clone() const override { return std::make_unique<Of>(*this); }
  };
  return Shape(std::make_unique<Of>(std::move(model)));
}

/// What the body answers: its shape and the force law that belongs to it. One model gives both with
/// `response`; the others have the law of the paper.
struct Answer {
  Shape shape;
  palpate::DuffingMap<S> force;
};

/// By options.shape: skeleton, half-space, response or none.
[[nodiscard]] Answer make_answer(const Options& options, const Body& body, const Tool& tool);

// One file each.
[[nodiscard]] Shape skeleton_shape(const Body& body);
[[nodiscard]] Shape half_space_shape(const Body& body);
[[nodiscard]] Answer response_answer(const Body& body, const Tool& tool);

/// A law that is the same all over the body.
[[nodiscard]] palpate::DuffingMap<S> same_everywhere(const Body& body,
                                                     const palpate::DuffingForce<S>::Params& law);

/// The lowest tenth of the body is fixed, for the models that need a region: y [m] of its top.
[[nodiscard]] inline S fixed_below(const Body& body) {
  return body.lower().y() + S(0.1) * (body.upper().y() - body.lower().y());
}

/// w, by which the paper's shape makes a contact's D shallower (V.B).
[[nodiscard]] S local_factor(const palpate::ContactState<S>& contact);

/// The vertices and normals that a solver draws into.
class Drawing {
 public:
  explicit Drawing(const palpate::MeshData<S>& rest)
      : position_(rest.vertices), normal_(rest.vertices.size(), V::Zero()) {}

  [[nodiscard]] Shape::Buffer buffer() noexcept {
    return {.positions = position_.front().data(),
            .position_stride = sizeof(V),
            .normals = normal_.front().data(),
            .normal_stride = sizeof(V)};
  }
  [[nodiscard]] const std::vector<V>& positions() const noexcept { return position_; }
  [[nodiscard]] const std::vector<V>& normals() const noexcept { return normal_; }

 private:
  std::vector<V> position_, normal_;
};

}  // namespace touch
