// SPDX-License-Identifier: MIT
#include <palpate/core/simd_shuffle.hpp>
#include <palpate/core/simd_vec3.hpp>
#include <palpate/core/vector.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

using namespace palpate;
using namespace palpate::detail;

namespace {
template <class V>
std::array<ValueOf<V>, size_of<V>> entries(const V& x) {
  std::array<ValueOf<V>, size_of<V>> result;
  store(result.data(), x);
  return result;
}
// Numbers whose sums and products are exact, of both signs, with a zero and equal pairs.
template <class V>
V numbers(int shift) {
  using T = ValueOf<V>;
  std::array<T, size_of<V>> x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = T((static_cast<int>(i) * 5 + shift) % 13 - 6) / T(8);
  return load<V>(x.data());
}
// Every entry of `simd` is what `scalar` gives for the entries of x and y.
template <class V, class Result, class Scalar>
void check(const V& x, const V& y, const Result& simd, const Scalar& scalar) {
  const auto a = entries(x), b = entries(y), c = entries(simd);
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(c[i] == scalar(a[i], b[i]));
}
template <class V, class Mask, class Scalar>
void check_mask(const V& x, const V& y, const Mask& mask, const Scalar& scalar) {
  const auto a = entries(x), b = entries(y);
  bool any = false, all = true;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool expected = scalar(a[i], b[i]);
    if constexpr (Real<V>)
      CHECK(mask == expected);
    else
      CHECK(mask[i] == expected);
    any |= expected, all &= expected;
  }
  CHECK(any_of(mask) == any);
  CHECK(all_of(mask) == all);
}
}  // namespace

#define ALL_TYPES                                                                                    \
  float, double, long double, Simd<float, 1>, Simd<double, 1>, Simd<long double, 2>, Simd<float, 4>, \
      Simd<double, 4>, native_simd<float>, native_simd<double>, native_simd<long double>,            \
      simd_at_most<float, 8>, simd_group<float>, simd_group<double>, Simd<float, 16>, Simd<double, 16>

TEST_CASE_TEMPLATE("every entry of a Simd is what the formula gives for a number", V, ALL_TYPES) {
  using T = ValueOf<V>;
  const T two(2);
  for (int shift = 0; shift < 13; ++shift) {
    const V x = numbers<V>(shift), y = numbers<V>(3 * shift + 1), above = y + two;
    check(x, y, V(x + y), [](T a, T b) { return a + b; });
    check(x, y, V(x - y), [](T a, T b) { return a - b; });
    check(x, y, V(x * y), [](T a, T b) { return a * b; });
    check(x, above, V(x / above), [](T a, T b) { return a / b; });
    check(x, y, V(-x), [](T a, T) { return -a; });
    check(x, y, V(two * x - T(1)), [](T a, T) { return T(2) * a - T(1); });
    check(x, y, V(T(1) - x * two + y / two), [](T a, T b) { return T(1) - a * T(2) + b / T(2); });
    V z = x;
    z += y, z *= x, z -= T(1), z /= T(4);
    check(x, y, z, [](T a, T b) { return ((a + b) * a - T(1)) / T(4); });

    check(x, y, V((max)(x, y)), [](T a, T b) { return std::max(a, b); });
    check(x, y, V((min)(x, y)), [](T a, T b) { return std::min(a, b); });
    check(x, y, V((max)(x, T(0))), [](T a, T) { return std::max(a, T(0)); });
    check(x, y, V((min)(T(0), x)), [](T a, T) { return std::min(a, T(0)); });
    check(x, y, V(clamp(x, T(-0.25), T(0.5))), [](T a, T) { return std::clamp(a, T(-0.25), T(0.5)); });
    check(x, y, V(abs(x)), [](T a, T) { return std::abs(a); });
    check(x, y, V(floor(x)), [](T a, T) { return std::floor(a); });
    check(above, y, V(sqrt(above)), [](T a, T) { return std::sqrt(a); });  // correctly rounded

    check_mask(x, y, x < y, [](T a, T b) { return a < b; });
    check_mask(x, y, x <= y, [](T a, T b) { return a <= b; });
    check_mask(x, y, x > y, [](T a, T b) { return a > b; });
    check_mask(x, y, x >= y, [](T a, T b) { return a >= b; });
    check_mask(x, y, x == y, [](T a, T b) { return a == b; });
    check_mask(x, y, x != y, [](T a, T b) { return a != b; });
    check_mask(x, y, x > T(0) && y > T(0), [](T a, T b) { return a > T(0) && b > T(0); });
    check_mask(x, y, x > T(0) || y > T(0), [](T a, T b) { return a > T(0) || b > T(0); });
    check_mask(x, y, !(x > T(0)), [](T a, T) { return !(a > T(0)); });
    check(x, y, V(select(x < y, x, T(0))), [](T a, T b) { return a < b ? a : T(0); });

    const auto a = entries(x);
    T sum(0);
    for (const T entry : a) sum += entry;  // exact in every order
    CHECK(reduce(x) == sum);
    CHECK(reduce_min(x) == *std::min_element(a.begin(), a.end()));
    CHECK(reduce_max(x) == *std::max_element(a.begin(), a.end()));
  }
}

TEST_CASE_TEMPLATE("a mask and a test see every entry alone", V, ALL_TYPES) {
  using T = ValueOf<V>;
  CHECK(!any_of(V{} > V{}));
  CHECK(all_of(V{} == V{}));
  for (std::size_t i = 0; i < size_of<V>; ++i) {
    for (const T bad : {std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity(),
                        std::numeric_limits<T>::quiet_NaN()}) {
      std::array<T, size_of<V>> one{};
      CHECK(all_of(palpate::is_finite(load<V>(one.data()))));
      one[i] = bad;
      CHECK(!all_of(palpate::is_finite(load<V>(one.data()))));
    }
    std::array<T, size_of<V>> one{};
    one[i] = T(1);
    const V x = load<V>(one.data());
    CHECK(any_of(x > V{}));
    CHECK(!all_of(x == V{}));
    CHECK(!any_of(-x > V{}));
    CHECK(reduce(x) == T(1));
    CHECK(reduce_max(x) == T(1));
    CHECK(reduce_min(V(-x)) == T(-1));
  }
  // The second argument where the first is not a number.
  const T nan = std::numeric_limits<T>::quiet_NaN();
  for (const T x : entries(V((max)(V(nan), V(T(1)))))) CHECK(x == T(1));
  for (const T x : entries(V((min)(V(nan), V(T(1)))))) CHECK(x == T(1));
}

TEST_CASE_TEMPLATE("entries of a Simd: one by one, from memory, of a register, of another type", V,
                   Simd<float, 1>, Simd<double, 1>, Simd<float, 4>, Simd<double, 4>, native_simd<float>,
                   native_simd<double>, simd_group<float>, simd_group<double>, Simd<float, 16>,
                   Simd<double, 16>) {
  using T = typename V::value_type;
  using U = std::conditional_t<std::same_as<T, float>, double, float>;
  static_assert(std::is_trivially_copyable_v<V> && sizeof(V) == V::size() * sizeof(T));
  V x = numbers<V>(1);
  const auto a = entries(x);
  const auto other = entries(simd_cast<U>(x));
  for (std::size_t i = 0; i < V::size(); ++i) {
    CHECK(x[i] == a[i]);
    CHECK(other[i] == static_cast<U>(a[i]));
    x.set(i, T(5));
    CHECK(x[i] == T(5));
    CHECK(reduce_max(x) == T(5));
    x.set(i, a[i]);
  }
  for (const T entry : entries(V(T(3)))) CHECK(entry == T(3));
  for (const T entry : entries(V{})) CHECK(entry == T(0));
  const auto factor = simd_factor<T>(T(2));
  if constexpr (V::size() >= native_simd<T>::size())
    for (std::size_t i = 0; i < V::size(); ++i) {
      CHECK(V(factor * x)[i] == T(2) * a[i]);
      CHECK(V(x + factor)[i] == a[i] + T(2));
    }
  CHECK(padded<V>(0) == 0);
  CHECK(padded<V>(1) == V::size());
  CHECK(padded<V>(V::size() + 1) == 2 * V::size());
}

TEST_CASE("four numbers one by one, and whole numbers") {
  const Simd<float, 4> x(1, 2, 3, 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(x[i] == static_cast<float>(i + 1));
  const auto bits = std::bit_cast<WordsOf<Simd<float, 4>>>(x);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto word = std::bit_cast<std::uint32_t>(x[i]);
    CHECK((bits >> 3)[i] == word >> 3);
    CHECK((bits << 3)[i] == word << 3);
    CHECK((bits & 0xff00ff00u)[i] == (word & 0xff00ff00u));
    CHECK((bits | 1u)[i] == (word | 1u));
    CHECK((7u - bits)[i] == 7u - word);
  }
}

TEST_CASE_TEMPLATE("vectors of space in registers", V, float, double, Simd<float, 4>, simd_group<double>) {
  using T = ValueOf<V>;
  SimdVec3<V> a{numbers<V>(0), numbers<V>(1), numbers<V>(2)};
  const SimdVec3<V> b{numbers<V>(5), numbers<V>(7), numbers<V>(11)};
  const SimdVec3<V> sum = a + b, difference = a - b, twice = V(T(2)) * a, product = cross(a, b);
  const V scalar = dot(a, b);
  a += b, a -= b;
  const auto at = [](const V& x, std::size_t i) { return entries(x)[i]; };
  for (std::size_t i = 0; i < size_of<V>; ++i) {
    const Vec3<T> u(at(a.x, i), at(a.y, i), at(a.z, i)), v(at(b.x, i), at(b.y, i), at(b.z, i));
    const auto equal = [&](const SimdVec3<V>& w, const Vec3<T>& expected) {
      return at(w.x, i) == expected.x() && at(w.y, i) == expected.y() && at(w.z, i) == expected.z();
    };
    CHECK(equal(sum, u + v));
    CHECK(equal(difference, u - v));
    CHECK(equal(twice, T(2) * u));
    CHECK(equal(product, u.cross(v)));
    CHECK(at(scalar, i) == u.dot(v));
  }
}

TEST_CASE_TEMPLATE("shuffles: rows and columns, parts, interleaved and scattered stores", V, Simd<float, 4>,
                   simd_at_most<float, 8>, native_simd<float>) {
  constexpr std::size_t n = V::size();
  std::array<float, 3 * n> row;
  for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<float>(i + 1);
  const V x(row.data()), y(row.data() + n), z(row.data() + 2 * n);

  std::array<float, 3 * n> packed;
  store_interleaved(reinterpret_cast<unsigned char*>(packed.data()), x, y, z);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) CHECK(packed[3 * i + k] == row[k * n + i]);

  std::size_t parts = 0;
  for_each_chunk<4>(x, [&](auto first, const Simd<float, 4>& part) {
    CHECK(first == 4 * parts++);
    for (std::size_t i = 0; i < 4; ++i) CHECK(part[i] == x[first + i]);
  });
  CHECK(parts == n / 4);

  if constexpr (n == 4) {
    Simd<float, 4> a = x, b = y, c = z, d = -x;
    transpose(a, b, c, d);
    const std::array<Simd<float, 4>, 4> column{a, b, c, d};
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(column[i][0] == x[i]);
      CHECK(column[i][1] == y[i]);
      CHECK(column[i][2] == z[i]);
      CHECK(column[i][3] == -x[i]);
      CHECK(rotated(x)[i] == x[i < 3 ? (i + 1) % 3 : 3]);
    }
    std::array<float, 20> apart{};
    const auto at = [&apart](std::size_t i) { return reinterpret_cast<unsigned char*>(apart.data() + i); };
    store_apart(at(5), at(10), at(0), at(15), x, y, z);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(apart[5 + k] == row[4 * k]);
      CHECK(apart[10 + k] == row[4 * k + 1]);
      CHECK(apart[0 + k] == row[4 * k + 2]);
      CHECK(apart[15 + k] == row[4 * k + 3]);
    }
    std::array<float, 20> fours{};
    store_by_fours(fours.data(), x, y, z, 5);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) CHECK(fours[5 * i + k] == row[4 * k + i]);
  }
}
