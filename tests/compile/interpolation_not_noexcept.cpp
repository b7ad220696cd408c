// SPDX-License-Identifier: MIT
// The field is drawn in the servo loop, where an exception has nowhere to go.
// expect: HasAdd
// expect: noexcept
#include <palpate/luo_xiao/interpolation/concept.hpp>

#ifdef PALPATE_MUST_FAIL
#define MAY_THROW
#else
#define MAY_THROW noexcept
#endif

struct Stiff {
  using Scalar = float;
  struct Load {};
  const palpate::FacePartition<float>& partition() const noexcept { return *faces; }
  void prepare(std::span<const palpate::Vec3<float>>, const palpate::ContactDisplacement<float>&,
               Load&) const noexcept {}
  bool moves(const Load&, std::size_t) const noexcept { return false; }
  bool same(const Load&, const Load&, std::size_t) const noexcept { return true; }
  void add(const Load&, std::size_t, std::size_t, std::size_t, const float*,
           const palpate::Lists<const float>&, const palpate::Lists<float>&) const MAY_THROW {}
  const palpate::FacePartition<float>* faces = nullptr;
};

template <palpate::Interpolation I>
struct Field {
  I interpolation;
};

int main() { return Field<Stiff>{}.interpolation.moves({}, 0) ? 1 : 0; }
