// SPDX-License-Identifier: MIT
// A deformation model that a user wrote, as docs/extending.md shows it.
#include <palpate/elasticity/concept.hpp>

#include <support/check.hpp>

#include <vector>

using namespace palpate;

namespace {

using V = Vec3<double>;

// [extending]
struct Putty {  // a deformation model: each vertex moves with the contacts nearer than `radius`
  using Scalar = double;
  static constexpr bool active = true;
  std::vector<V> rest;  // m
  double radius;        // m
  template <class T>
  void write_rest(const palpate::VertexBuffer<T>& out) noexcept {
    (void)write({}, out);
  }
  template <class T>
  palpate::Moved<double> write(std::span<const palpate::ContactState<double>> contacts,
                               const palpate::VertexBuffer<T>& out) noexcept {
    palpate::Moved<double> moved{rest.size(), rest[0], rest[0]};
    for (std::size_t i = 0; i < rest.size(); ++i) {
      V x = rest[i];
      for (const auto& c : contacts)
        x += (std::max)(0.0, 1 - (rest[i] - c.origin()).norm() / radius) * c.displacement;
      for (int k = 0; k < 3; ++k)
        out.positions[i * out.position_stride / sizeof(T) + std::size_t(k)] = T(x[k]);
      moved.lower = moved.lower.cwiseMin(x), moved.upper = moved.upper.cwiseMax(x);
    }
    return moved;
  }
};
// [extending]
static_assert(DeformationModel<Putty>);

}  // namespace

TEST_CASE("the user's deformation model: a dent under the contact, nothing far from it") {
  Putty putty{{V(0, 0, 0), V(0.01, 0, 0), V(0.1, 0, 0)}, 0.02};
  std::vector<double> x(9);
  const VertexBuffer<double> out{.positions = x.data()};
  putty.write_rest(out);
  CHECK(x == std::vector<double>{0, 0, 0, 0.01, 0, 0, 0.1, 0, 0});
  ContactState<double> contact{};
  contact.displacement = V(0, -1e-3, 0);
  contact.centre = contact.displacement;
  CHECK(putty.write({&contact, 1}, out).vertices == 3);
  CHECK(x == std::vector<double>{0, -1e-3, 0, 0.01, -0.5e-3, 0, 0.1, 0, 0});
}
