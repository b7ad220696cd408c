// SPDX-License-Identifier: MIT
// expect: HasWrite<D>
// expect-clang: model.write\(contacts
#include <palpate/elasticity/concept.hpp>

struct Jelly {
  using Scalar = double;
  static constexpr bool active = true;
  template <class T>
  void write_rest(const palpate::VertexBuffer<T>&) noexcept {}
#ifndef PALPATE_MUST_FAIL
  template <class T>
  palpate::Moved<double> write(std::span<const palpate::ContactState<double>>,
                               const palpate::VertexBuffer<T>&) noexcept {
    return {};
  }
#endif
};

template <palpate::DeformationModel D>
struct Scene {
  D model;
};

int main() {
  Scene<Jelly>{}.model.write_rest(palpate::VertexBuffer<float>{});
  return 0;
}
