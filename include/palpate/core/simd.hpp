// SPDX-License-Identifier: MIT
#pragma once

/// @file Many numbers in vector registers, with the arithmetic of one: `Simd<T, N>`, spelled as in C++26's
/// std::simd.
///
/// | type                 | holds                                                                       |
/// |----------------------|-----------------------------------------------------------------------------|
/// | `Simd<T, N>`         | N numbers; N = 1 is plain arithmetic                                        |
/// | `native_simd<T>`     | as many as the widest register holds                                        |
/// | `simd_at_most<T, N>` | the same, but no more than N                                                |
/// | `simd_group<T>`      | four registers (two of AVX-512's): for long formulas, see below             |
/// | `simd_factor<T>`     | one number that meets many Simd: a register unless a load can repeat it     |
///
/// A formula is written once, for a type V: a Simd, or float, double or long double, for which every function
/// below is there, too. A comparison gives a mask; `select(mask, a, b)` is a where it is true. Why registers
/// of the compiler and no expression templates: operations run at once, and each of Eigen's terms is a type,
/// over thousands of which gcc takes seconds and gigabytes.
///
/// Why groups: the operations of a long formula wait for each other. A processor hides that by working on the
/// loop's next passes meanwhile, as far as its window of instructions goes, which is half as long where two
/// threads share a core: one or two passes of a formula of a hundred instructions. Where every operation is
/// done for several registers, others are always at hand. More than four do not stay in registers.
///
/// The register is part of the type's name, so that objects compiled with other vector flags do not take this
/// one's functions for theirs. Data that cross a function which is not inlined are arrays in memory.
///
/// Functions of the names `min` and `max` are called in parentheses: Windows has macros of these names.

#include <palpate/core/detail/simd_register.hpp>
#include <palpate/core/scalar.hpp>

namespace palpate::detail {

template <class T>
concept SimdEntry = Real<T> || std::same_as<T, std::uint32_t> || std::same_as<T, std::uint64_t>;

// Writes `expression` of every register k to `result`, out in full: compilers keep short loops at -O2, and
// their arrays in memory.
#define PALPATE_EACH_REGISTER(result, expression)                            \
  if constexpr (registers == 1) {                                            \
    constexpr std::size_t k = 0;                                             \
    result.native[k] = expression;                                           \
  } else {                                                                   \
    [&]<std::size_t... k>(std::index_sequence<k...>) PALPATE_INLINE_LAMBDA { \
      ((result.native[k] = expression), ...);                                \
    }(std::make_index_sequence<registers>{});                                \
  }

/// What a comparison of two Simd<T, N> gives: true or false for each entry.
template <SimdEntry T, int N, class Register>
class SimdMask {
 public:
  using Part = MaskOf<Register>;
  static constexpr std::size_t registers = static_cast<std::size_t>(N) / register_size<Register>;

  SimdMask() = default;  ///< SimdMask{}: false
  [[nodiscard]] static constexpr std::size_t size() noexcept { return N; }
  [[nodiscard]] PALPATE_INLINE bool operator[](std::size_t i) const noexcept {
    if constexpr (std::same_as<Part, bool>)
      return native[i];
    else
      return native[i / register_size<Register>][i % register_size<Register>] != 0;
  }

#define PALPATE_OPERATOR(op, each)                                                                          \
  [[nodiscard]] friend PALPATE_INLINE SimdMask operator op(const SimdMask& a, const SimdMask& b) noexcept { \
    SimdMask result;                                                                                        \
    PALPATE_EACH_REGISTER(result, Part(a.native[k] each b.native[k]))                                       \
    return result;                                                                                          \
  }
  PALPATE_OPERATOR(&&, &)
  PALPATE_OPERATOR(||, |)
#undef PALPATE_OPERATOR
  [[nodiscard]] PALPATE_INLINE SimdMask operator!() const noexcept {
    SimdMask result;
    PALPATE_EACH_REGISTER(result, Part(native[k] == 0))
    return result;
  }

  Part native[registers];  ///< as the compiler knows them
};

/// N numbers in registers. Arithmetic is entry by entry; a number meets every entry.
template <SimdEntry T, int N, class Register = RegisterFor<T, N>>
class Simd {
 public:
  using value_type = T;
  using mask_type = SimdMask<T, N, Register>;
  using register_type = Register;
  static constexpr std::size_t registers = static_cast<std::size_t>(N) / register_size<Register>;
  [[nodiscard]] static constexpr std::size_t size() noexcept { return N; }

  Simd() = default;  ///< Simd{}: zeros
  /// The same in every entry.
  PALPATE_INLINE Simd(T x) noexcept {
    const Register all = broadcast<Register>(x);
    PALPATE_EACH_REGISTER((*this), all)
  }
  /// The same in every register.
  template <int M>
    requires(registers > 1 && M == static_cast<int>(register_size<Register>))
  PALPATE_INLINE Simd(const Simd<T, M, Register>& x) noexcept {
    PALPATE_EACH_REGISTER((*this), x.native[0])
  }
  /// Entry by entry.
  template <std::convertible_to<T>... Rest>
    requires(N > 1 && sizeof...(Rest) + 2 == N)
  PALPATE_INLINE Simd(T x0, T x1, Rest... x) noexcept {
    if constexpr (registers == 1)  // from memory it would wait for the entries' stores
      native[0] = Register{x0, x1, static_cast<T>(x)...};
    else
      copy_from(std::array<T, N>{x0, x1, static_cast<T>(x)...}.data());
  }
  /// N numbers from memory, wherever they lie.
  template <std::same_as<T> U>
  PALPATE_INLINE explicit Simd(const U* from) noexcept {
    copy_from(from);
  }
  PALPATE_INLINE void copy_from(const T* from) noexcept {
    PALPATE_EACH_REGISTER((*this), load_native<Register>(from + k * register_size<Register>));
  }
  PALPATE_INLINE void copy_to(T* to) const noexcept { std::memcpy(to, native, sizeof native); }

  [[nodiscard]] PALPATE_INLINE T operator[](std::size_t i) const noexcept {
    if constexpr (std::is_arithmetic_v<Register>)
      return native[i];
    else
      return native[i / register_size<Register>][i % register_size<Register>];
  }
  PALPATE_INLINE void set(std::size_t i, T x) noexcept {
    if constexpr (std::is_arithmetic_v<Register>)
      native[i] = x;
    else
      native[i / register_size<Register>][i % register_size<Register>] = x;
  }

#define PALPATE_OPERATOR(op)                                                                    \
  [[nodiscard]] friend PALPATE_INLINE Simd operator op(const Simd& a, const Simd& b) noexcept { \
    Simd result;                                                                                \
    PALPATE_EACH_REGISTER(result, Register(a.native[k] op b.native[k]))                         \
    return result;                                                                              \
  }                                                                                             \
  PALPATE_INLINE Simd& operator op##=(const Simd& b) noexcept { return *this = *this op b; }
  PALPATE_OPERATOR(+)
  PALPATE_OPERATOR(-)
  PALPATE_OPERATOR(*)
  PALPATE_OPERATOR(/)
  PALPATE_OPERATOR(&)  // this and below: of whole numbers
  PALPATE_OPERATOR(|)
#undef PALPATE_OPERATOR
#define PALPATE_OPERATOR(op)                                                             \
  [[nodiscard]] friend PALPATE_INLINE Simd operator op(const Simd& a, int by) noexcept { \
    Simd result;                                                                         \
    PALPATE_EACH_REGISTER(result, Register(a.native[k] op by))                           \
    return result;                                                                       \
  }
  PALPATE_OPERATOR(<<)
  PALPATE_OPERATOR(>>)
#undef PALPATE_OPERATOR
  [[nodiscard]] PALPATE_INLINE Simd operator-() const noexcept {
    Simd result;
    PALPATE_EACH_REGISTER(result, Register(-native[k]))
    return result;
  }

#define PALPATE_OPERATOR(op)                                                                         \
  [[nodiscard]] friend PALPATE_INLINE mask_type operator op(const Simd& a, const Simd& b) noexcept { \
    mask_type result;                                                                                \
    PALPATE_EACH_REGISTER(result, a.native[k] op b.native[k])                                        \
    return result;                                                                                   \
  }
  PALPATE_OPERATOR(<)
  PALPATE_OPERATOR(<=)
  PALPATE_OPERATOR(>)
  PALPATE_OPERATOR(>=)
  PALPATE_OPERATOR(==)
  PALPATE_OPERATOR(!=)
#undef PALPATE_OPERATOR

  /// a where the mask is true, else b.
  [[nodiscard]] friend PALPATE_INLINE Simd select(const mask_type& mask, const Simd& a,
                                                  const Simd& b) noexcept {
    Simd result;
    PALPATE_EACH_REGISTER(result, Register(mask.native[k] ? a.native[k] : b.native[k]))
    return result;
  }

  /// f(register k) of every register.
  template <class F>
  [[nodiscard]] PALPATE_INLINE Simd map(const F& f) const noexcept {
    Simd result;
    PALPATE_EACH_REGISTER(result, f(native[k]))
    return result;
  }
  /// f(register k of a, register k of b).
  template <class F>
  [[nodiscard]] static PALPATE_INLINE Simd map(const Simd& a, const Simd& b, const F& f) noexcept {
    Simd result;
    PALPATE_EACH_REGISTER(result, f(a.native[k], b.native[k]))
    return result;
  }
  Register native[registers];  ///< as the compiler knows them
};

/// How many T the widest register holds; 1 for long double.
template <class T>
inline constexpr int native_size = sizeof(T) <= 8 ? static_cast<int>(native_bytes / sizeof(T)) : 1;
template <SimdEntry T>
using native_simd = Simd<T, native_size<T>>;
template <SimdEntry T, int N>
using simd_at_most = Simd<T, (native_size<T> < N ? native_size<T> : N)>;
template <SimdEntry T>
using simd_group = Simd<T, native_size<T>*(native_bytes == 64 && sizeof(T) <= 8 ? 2 : 4)>;
#if defined(__AVX__)
template <Real T>
using simd_factor = T;
#else
template <Real T>
using simd_factor = native_simd<T>;
#endif

/// What a formula may be written for: a Simd, or a number.
template <class V>
inline constexpr bool is_simd = false;
template <class T, int N, class R>
inline constexpr bool is_simd<Simd<T, N, R>> = true;
template <class V>
concept SimdOrReal = Real<V> || is_simd<V>;

template <class T>
using WordOf = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
template <SimdOrReal V>
struct SimdTraits {
  using Value = V;
  using Words = WordOf<V>;
  static constexpr std::size_t size = 1;
};
template <class T, int N, class R>
struct SimdTraits<Simd<T, N, R>> {
  using Value = T;
  using Words = Simd<WordOf<T>, N>;
  static constexpr std::size_t size = static_cast<std::size_t>(N);
};
/// What V's entries are, and how many it has.
template <SimdOrReal V>
using ValueOf = typename SimdTraits<V>::Value;
template <SimdOrReal V>
inline constexpr std::size_t size_of = SimdTraits<V>::size;
/// Its bits as whole numbers: std::bit_cast<WordsOf<V>>(x). Not of long double.
template <SimdOrReal V>
using WordsOf = typename SimdTraits<V>::Words;
/// n rounded up to whole V.
template <SimdOrReal V>
[[nodiscard]] constexpr std::size_t padded(std::size_t n) noexcept {
  return (n + size_of<V> - 1) / size_of<V> * size_of<V>;
}

template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V load(const ValueOf<V>* from) noexcept {
  if constexpr (Real<V>)
    return *from;
  else
    return V(from);
}
template <SimdOrReal V>
PALPATE_INLINE void store(ValueOf<V>* to, const V& x) noexcept {
  if constexpr (Real<V>)
    *to = x;
  else
    x.copy_to(to);
}

/// a > b ? a : b and a < b ? a : b, entry by entry: b where one is not a number.
#define PALPATE_EXTREMUM(name, op)                                                                      \
  template <Real T>                                                                                     \
  [[nodiscard]] PALPATE_INLINE T(name)(T a, T b) noexcept {                                             \
    return a op b ? a : b;                                                                              \
  }                                                                                                     \
  template <class T, int N, class R>                                                                    \
  [[nodiscard]] PALPATE_INLINE Simd<T, N, R>(name)(const Simd<T, N, R>& a,                              \
                                                   const Simd<T, N, R>& b) noexcept {                   \
    return Simd<T, N, R>::map(                                                                          \
        a, b, [](const R& p, const R& q) PALPATE_INLINE_LAMBDA -> R { return register_##name(p, q); }); \
  }                                                                                                     \
  template <class T, int N, class R>                                                                    \
  [[nodiscard]] PALPATE_INLINE Simd<T, N, R>(name)(const Simd<T, N, R>& a,                              \
                                                   std::type_identity_t<T> b) noexcept {                \
    return (name)(a, Simd<T, N, R>(b));                                                                 \
  }                                                                                                     \
  template <class T, int N, class R>                                                                    \
  [[nodiscard]] PALPATE_INLINE Simd<T, N, R>(name)(std::type_identity_t<T> a,                           \
                                                   const Simd<T, N, R>& b) noexcept {                   \
    return (name)(Simd<T, N, R>(a), b);                                                                 \
  }
PALPATE_EXTREMUM(max, >)
PALPATE_EXTREMUM(min, <)
#undef PALPATE_EXTREMUM
/// x, but at least `low` and at most `high`; `high` where x is not a number.
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V clamp(const V& x, ValueOf<V> low, ValueOf<V> high) noexcept {
  return (min)((max)(x, low), high);
}

template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V sqrt(const V& x) noexcept {
  if constexpr (Real<V>)
    return std::sqrt(x);
  else
    return x.map([](const auto& r) PALPATE_INLINE_LAMBDA { return register_sqrt(r); });
}
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V abs(const V& x) noexcept {
  if constexpr (Real<V>)
    return std::abs(x);
  else
    return x.map([](const auto& r) PALPATE_INLINE_LAMBDA { return register_abs(r); });
}
/// The whole number at or below x; of |x| < 2^22 (float) or 2^51.
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V floor(const V& x) noexcept {
  if constexpr (Real<V>)
    return std::floor(x);
  else
    return x.map([](const auto& r) PALPATE_INLINE_LAMBDA { return register_floor(r); });
}
template <Real T>
[[nodiscard]] PALPATE_INLINE T select(bool condition, T a, T b) noexcept {
  return condition ? a : b;
}

[[nodiscard]] PALPATE_INLINE bool any_of(bool mask) noexcept { return mask; }
[[nodiscard]] PALPATE_INLINE bool all_of(bool mask) noexcept { return mask; }
template <class T, int N, class R>
[[nodiscard]] PALPATE_INLINE bool any_of(const SimdMask<T, N, R>& mask) noexcept {
  MaskOf<R> any = mask.native[0];
  for (std::size_t k = 1; k < SimdMask<T, N, R>::registers; ++k) any = any | mask.native[k];
  return register_any(any);
}
template <class T, int N, class R>
[[nodiscard]] PALPATE_INLINE bool all_of(const SimdMask<T, N, R>& mask) noexcept {
  return !any_of(!mask);
}

/// The sum, the least and the greatest of all entries. Registers by twos, then a register's first half with
/// its second: the order of Eigen's sums.
template <std::size_t first, std::size_t count, class V, class Op>
[[nodiscard]] PALPATE_INLINE auto combined(const V& x, const Op& op) noexcept {
  if constexpr (count == 1)
    return x.native[first];
  else
    return op(combined<first, count / 2>(x, op), combined<first + count / 2, count - count / 2>(x, op));
}
template <class V, class Op>
[[nodiscard]] PALPATE_INLINE ValueOf<V> reduce(const V& x, const Op& op) noexcept {
  return register_reduce(combined<0, V::registers>(x, op), op);
}
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE ValueOf<V> reduce(const V& x) noexcept {
  if constexpr (Real<V>)
    return x;
  else
    return reduce(x, [](const auto& a, const auto& b) PALPATE_INLINE_LAMBDA { return a + b; });
}
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE ValueOf<V> reduce_min(const V& x) noexcept {
  if constexpr (Real<V>)
    return x;
  else
    return reduce(x, [](const auto& a, const auto& b) PALPATE_INLINE_LAMBDA { return register_min(a, b); });
}
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE ValueOf<V> reduce_max(const V& x) noexcept {
  if constexpr (Real<V>)
    return x;
  else
    return reduce(x, [](const auto& a, const auto& b) PALPATE_INLINE_LAMBDA { return register_max(a, b); });
}

#undef PALPATE_EACH_REGISTER
}  // namespace palpate::detail

namespace palpate {
/// is_finite() of every entry.
template <class T, int N, class R>
[[nodiscard]] PALPATE_INLINE detail::SimdMask<T, N, R> is_finite(const detail::Simd<T, N, R>& x) noexcept {
  detail::SimdMask<T, N, R> result;
  for (std::size_t k = 0; k < x.registers; ++k) {
    if constexpr (std::same_as<R, T>) {
      result.native[k] = palpate::is_finite(x.native[k]);
    } else {
      using Bits = detail::MaskOf<R>;
      constexpr auto exponent =
          std::bit_cast<detail::RegisterEntry<Bits>>(std::numeric_limits<T>::infinity());
      result.native[k] = (std::bit_cast<Bits>(x.native[k]) & exponent) != exponent;
    }
  }
  return result;
}
}  // namespace palpate
