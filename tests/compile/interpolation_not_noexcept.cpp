// SPDX-License-Identifier: MIT
// The field is drawn in the servo loop, where an exception has nowhere to go.
// expect: HasDisplacement
// expect: noexcept
#include <palpate/luo_xiao/interpolation/concept.hpp>

#ifdef PALPATE_MUST_FAIL
#define MAY_THROW
#else
#define MAY_THROW noexcept
#endif

struct Stiff {
  using Scalar = float;
  palpate::Vec3<float> displacement(std::span<const float>, std::span<const palpate::FaceCorner<float>>,
                                    const palpate::Vec3<float>&) const MAY_THROW {
    return palpate::Vec3<float>::Zero();
  }
};

template <palpate::VertexInterpolation I>
struct Field {
  I interpolation;
};

int main() { return Field<Stiff>{}.interpolation.displacement({}, {}, {}).isZero() ? 0 : 1; }
