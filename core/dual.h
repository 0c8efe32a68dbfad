// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines dual numbers: real numbers that carry their derivatives by N parameters through every operation
// (forward mode; A. Griewank, A. Walther, "Evaluating Derivatives", 2nd ed., SIAM 2008, chapter 3). The
// derivatives are exact to the rounding of fp64.
//
// Physics that is to be differentiated is a template on its real type R. With R = double it is what it would
// be without derivatives, bit by bit. With R = Dual its values are the same, because every operation computes
// its value as the operation on doubles does. Such code calls functions without their namespaces (sqrt, dot),
// after `using std::sqrt;`, and takes its types from R:
//
//   R        ComplexOf<R>             Vec3Of<R>   Vec2Of<R>
//   double   std::complex<double>     dvec3       dvec2
//   Dual     DualComplex              Vector3<R>  Vector2<R>
//
// Comparisons look at values alone, so that a branch gives the derivative of the side on which the value
// lies. Where a function has no derivative, the result is infinite (sqrt at 0) or that of one side (abs, min,
// max). A derivative of 0 stays 0 there: what does not depend on a parameter never becomes infinite or NaN.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <complex>
#include <limits>
#include <type_traits>

#include "core/vec.h"

namespace greatx {

template <int N>
struct DualNumber {
  /// Two derivatives, which one instruction treats at once.
  using Pair = double __attribute__((vector_size(16)));
  static constexpr int count = N, pairs = N / 2;
  static_assert(N % 2 == 0, "the derivatives go in pairs");

  double value = 0.0;
  Pair slopes[pairs] = {};  ///< derivatives by the N parameters

  constexpr DualNumber() = default;
  constexpr DualNumber(double constant) : value(constant) {}  // NOLINT: a number is a dual number

  double slope(int i) const { return slopes[i / 2][i % 2]; }
  void set_slope(int i, double to) { slopes[i / 2][i % 2] = to; }
  bool constant() const {
    return std::all_of(slopes, slopes + pairs, [](const Pair& p) { return p[0] == 0.0 && p[1] == 0.0; });
  }

  /// Returns f of this number, given f and f' at its value.
  DualNumber mapped(double f, double derivative) const {
    DualNumber result(f);
    if (std::isfinite(derivative))
      for (int i = 0; i < pairs; ++i) result.slopes[i] = derivative * slopes[i];
    else
      for (int i = 0; i < N; ++i) result.set_slope(i, slope(i) == 0.0 ? 0.0 : derivative * slope(i));
    return result;
  }
  /// Returns f of a and b, given f and its partial derivatives.
  static DualNumber joined(double f, const DualNumber& a, double by_a, const DualNumber& b, double by_b) {
    DualNumber result(f);
    for (int i = 0; i < pairs; ++i) result.slopes[i] = by_a * a.slopes[i] + by_b * b.slopes[i];
    return result;
  }

  DualNumber operator-() const { return mapped(-value, -1.0); }
  DualNumber& operator+=(const DualNumber& other) { return *this = *this + other; }
  DualNumber& operator-=(const DualNumber& other) { return *this = *this - other; }
  DualNumber& operator*=(const DualNumber& other) { return *this = *this * other; }
  DualNumber& operator/=(const DualNumber& other) { return *this = *this / other; }

  friend DualNumber operator+(const DualNumber& a, const DualNumber& b) {
    DualNumber result(a.value + b.value);
    for (int i = 0; i < pairs; ++i) result.slopes[i] = a.slopes[i] + b.slopes[i];
    return result;
  }
  friend DualNumber operator+(const DualNumber& a, double b) {
    DualNumber result = a;
    result.value = a.value + b;
    return result;
  }
  friend DualNumber operator+(double a, const DualNumber& b) {
    DualNumber result = b;
    result.value = a + b.value;
    return result;
  }
  friend DualNumber operator-(const DualNumber& a, const DualNumber& b) {
    DualNumber result(a.value - b.value);
    for (int i = 0; i < pairs; ++i) result.slopes[i] = a.slopes[i] - b.slopes[i];
    return result;
  }
  friend DualNumber operator-(const DualNumber& a, double b) {
    DualNumber result = a;
    result.value = a.value - b;
    return result;
  }
  friend DualNumber operator-(double a, const DualNumber& b) {
    DualNumber result(a - b.value);
    for (int i = 0; i < pairs; ++i) result.slopes[i] = -b.slopes[i];
    return result;
  }
  friend DualNumber operator*(const DualNumber& a, const DualNumber& b) {
    return joined(a.value * b.value, a, b.value, b, a.value);
  }
  friend DualNumber operator*(const DualNumber& a, double b) { return scaled(a, a.value * b, b); }
  friend DualNumber operator*(double a, const DualNumber& b) { return scaled(b, a * b.value, a); }
  friend DualNumber operator/(const DualNumber& a, const DualNumber& b) {
    const double quotient = a.value / b.value, inverse = 1.0 / b.value;
    return joined(quotient, a, inverse, b, -quotient * inverse);
  }
  friend DualNumber operator/(const DualNumber& a, double b) { return scaled(a, a.value / b, 1.0 / b); }
  friend DualNumber operator/(double a, const DualNumber& b) {
    const double quotient = a / b.value;
    return scaled(b, quotient, -quotient / b.value);
  }

  friend bool operator==(const DualNumber& a, const DualNumber& b) { return a.value == b.value; }
  friend bool operator==(const DualNumber& a, double b) { return a.value == b; }
  friend std::partial_ordering operator<=>(const DualNumber& a, const DualNumber& b) {
    return a.value <=> b.value;
  }
  friend std::partial_ordering operator<=>(const DualNumber& a, double b) { return a.value <=> b; }

  friend DualNumber sqrt(const DualNumber& x) {
    const double root = std::sqrt(x.value);
    return x.mapped(root, 0.5 / root);
  }
  friend DualNumber exp(const DualNumber& x) {
    const double power = std::exp(x.value);
    return x.mapped(power, power);
  }
  friend DualNumber log10(const DualNumber& x) {
    return x.mapped(std::log10(x.value), 1.0 / (std::log(10.0) * x.value));
  }
  friend DualNumber sin(const DualNumber& x) { return x.mapped(std::sin(x.value), std::cos(x.value)); }
  friend DualNumber cos(const DualNumber& x) { return x.mapped(std::cos(x.value), -std::sin(x.value)); }
  friend DualNumber tan(const DualNumber& x) {
    const double tangent = std::tan(x.value);
    return x.mapped(tangent, 1.0 + tangent * tangent);
  }
  friend DualNumber atan(const DualNumber& x) {
    return x.mapped(std::atan(x.value), 1.0 / (1.0 + x.value * x.value));
  }
  friend DualNumber atan2(const DualNumber& y, const DualNumber& x) {
    const double square = x.value * x.value + y.value * y.value;
    return joined(std::atan2(y.value, x.value), y, x.value / square, x, -y.value / square);
  }
  friend DualNumber expm1(const DualNumber& x) { return x.mapped(std::expm1(x.value), std::exp(x.value)); }
  friend DualNumber hypot(const DualNumber& x, const DualNumber& y) {
    const double root = std::hypot(x.value, y.value);
    if (root == 0.0) return DualNumber(0.0);
    return joined(root, x, x.value / root, y, y.value / root);
  }
  friend DualNumber abs(const DualNumber& x) { return std::signbit(x.value) ? -x : x; }
  friend DualNumber pow(const DualNumber& base, double exponent) {
    return base.mapped(std::pow(base.value, exponent),
                       exponent == 0.0 ? 0.0 : exponent * std::pow(base.value, exponent - 1.0));
  }
  friend DualNumber pow(double base, const DualNumber& exponent) {
    const double power = std::pow(base, exponent.value);
    return exponent.mapped(power, power * std::log(base));
  }

 private:
  static DualNumber scaled(const DualNumber& x, double value, double by) {
    DualNumber result(value);
    for (int i = 0; i < pairs; ++i) result.slopes[i] = by * x.slopes[i];
    return result;
  }
};

/// A complex number whose parts are dual numbers. Its functions are analytic.
template <int N>
struct DualComplexNumber {
  using Real = DualNumber<N>;
  using Value = std::complex<double>;

  Real re, im;

  constexpr DualComplexNumber() = default;
  constexpr DualComplexNumber(const Real& real) : re(real) {}  // NOLINT: as std::complex
  constexpr DualComplexNumber(double real) : re(real) {}       // NOLINT
  constexpr DualComplexNumber(const Real& real, const Real& imag) : re(real), im(imag) {}
  constexpr DualComplexNumber(const Value& z) : re(z.real()), im(z.imag()) {}  // NOLINT

  const Real& real() const { return re; }
  const Real& imag() const { return im; }
  Value value() const { return {re.value, im.value}; }

  /// Returns f(z), given f and f' at the value of z.
  DualComplexNumber mapped(const Value& f, const Value& derivative) const {
    DualComplexNumber result(f);
    add_product(*this, derivative, result);
    return result;
  }

  DualComplexNumber operator-() const { return {-re, -im}; }
  DualComplexNumber& operator+=(const DualComplexNumber& z) { return re += z.re, im += z.im, *this; }
  DualComplexNumber& operator-=(const DualComplexNumber& z) { return re -= z.re, im -= z.im, *this; }
  DualComplexNumber& operator*=(const DualComplexNumber& z) { return *this = *this * z; }
  DualComplexNumber& operator/=(const DualComplexNumber& z) { return *this = *this / z; }

  friend DualComplexNumber operator+(const DualComplexNumber& a, const DualComplexNumber& b) {
    return {a.re + b.re, a.im + b.im};
  }
  friend DualComplexNumber operator+(const DualComplexNumber& a, double b) { return {a.re + b, a.im}; }
  friend DualComplexNumber operator+(double a, const DualComplexNumber& b) { return {a + b.re, b.im}; }
  friend DualComplexNumber operator-(const DualComplexNumber& a, const DualComplexNumber& b) {
    return {a.re - b.re, a.im - b.im};
  }
  friend DualComplexNumber operator-(const DualComplexNumber& a, double b) { return {a.re - b, a.im}; }
  friend DualComplexNumber operator-(double a, const DualComplexNumber& b) { return {a - b.re, -b.im}; }
  friend DualComplexNumber operator*(const DualComplexNumber& a, const DualComplexNumber& b) {
    DualComplexNumber result(a.value() * b.value());
    add_product(a, b.value(), result);
    add_product(b, a.value(), result);
    return result;
  }
  friend DualComplexNumber operator*(const DualComplexNumber& a, const Value& b) {
    return a.mapped(a.value() * b, b);
  }
  friend DualComplexNumber operator*(const Value& a, const DualComplexNumber& b) {
    return b.mapped(a * b.value(), a);
  }
  friend DualComplexNumber operator*(const DualComplexNumber& a, const Real& b) {
    return {a.re * b, a.im * b};
  }
  friend DualComplexNumber operator*(const Real& a, const DualComplexNumber& b) {
    return {a * b.re, a * b.im};
  }
  friend DualComplexNumber operator*(const DualComplexNumber& a, double b) { return {a.re * b, a.im * b}; }
  friend DualComplexNumber operator*(double a, const DualComplexNumber& b) { return {a * b.re, a * b.im}; }
  friend DualComplexNumber operator/(const DualComplexNumber& a, const DualComplexNumber& b) {
    const Value quotient = a.value() / b.value(), inverse = 1.0 / b.value();
    DualComplexNumber result(quotient);
    add_product(a, inverse, result);
    add_product(b, -quotient * inverse, result);
    return result;
  }
  friend DualComplexNumber operator/(const DualComplexNumber& a, const Real& b) {
    return {a.re / b, a.im / b};
  }
  friend DualComplexNumber operator/(const DualComplexNumber& a, double b) { return {a.re / b, a.im / b}; }
  friend DualComplexNumber operator/(double a, const DualComplexNumber& b) {
    const Value quotient = a / b.value();
    return b.mapped(quotient, -quotient / b.value());
  }

  friend bool operator==(const DualComplexNumber& a, const DualComplexNumber& b) {
    return a.value() == b.value();
  }

  friend Real norm(const DualComplexNumber& z) { return z.re * z.re + z.im * z.im; }
  friend Real abs(const DualComplexNumber& z) { return hypot(z.re, z.im); }
  friend DualComplexNumber conj(const DualComplexNumber& z) { return {z.re, -z.im}; }
  friend DualComplexNumber exp(const DualComplexNumber& z) {
    const Value power = std::exp(z.value());
    return z.mapped(power, power);
  }
  /// At 0 the derivatives are infinite, as those of a real root.
  friend DualComplexNumber sqrt(const DualComplexNumber& z) {
    const Value root = std::sqrt(z.value());
    if (root != 0.0) return z.mapped(root, 0.5 / root);
    return {sqrt(z.re), sqrt(z.im)};
  }

 private:
  /// Adds the derivatives of z, times a constant, to those of the result.
  static void add_product(const DualComplexNumber& z, const Value& by, DualComplexNumber& result) {
    const double real = by.real(), imag = by.imag();
    for (int i = 0; i < Real::pairs; ++i) {
      result.re.slopes[i] += real * z.re.slopes[i] - imag * z.im.slopes[i];
      result.im.slopes[i] += real * z.im.slopes[i] + imag * z.re.slopes[i];
    }
  }
};

template <int N>
DualComplexNumber<N> operator*(const std::complex<double>& a, const DualNumber<N>& b) {
  return {a.real() * b, a.imag() * b};
}
template <int N>
DualComplexNumber<N> operator*(const DualNumber<N>& a, const std::complex<double>& b) {
  return b * a;
}

template <int N>
DualComplexNumber<N> operator/(const std::complex<double>& a, const DualNumber<N>& b) {
  return {a.real() / b, a.imag() / b};
}

/// Vectors of numbers that are not built in, with what is needed of GLM's vectors.
template <typename R>
struct Vector2 {
  R x, y;
  Vector2() = default;
  Vector2(const R& of_x, const R& of_y) : x(of_x), y(of_y) {}
  Vector2(const dvec2& v) : x(v.x), y(v.y) {}  // NOLINT: a vector of constants
  Vector2 operator-() const { return {-x, -y}; }
  friend Vector2 operator*(const R& a, const Vector2& v) { return {a * v.x, a * v.y}; }
  friend R dot(const Vector2& a, const Vector2& b) { return a.x * b.x + a.y * b.y; }
};

template <typename R>
struct Vector3 {
  R x, y, z;
  Vector3() = default;
  Vector3(const R& of_x, const R& of_y, const R& of_z) : x(of_x), y(of_y), z(of_z) {}
  Vector3(const dvec3& v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT: a vector of constants

  R& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  const R& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  Vector3 operator-() const { return {-x, -y, -z}; }
  Vector3& operator+=(const Vector3& v) { return x += v.x, y += v.y, z += v.z, *this; }

  friend Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector3 operator+(const Vector3& a, const dvec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector3 operator+(const dvec3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector3 operator-(const Vector3& a, const dvec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector3 operator-(const dvec3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector3 operator*(const R& a, const Vector3& v) { return {a * v.x, a * v.y, a * v.z}; }
  friend Vector3 operator*(double a, const Vector3& v) { return {a * v.x, a * v.y, a * v.z}; }
  friend Vector3 operator*(const Vector3& v, const R& a) { return {v.x * a, v.y * a, v.z * a}; }
  friend Vector3 operator/(const Vector3& v, const R& a) { return {v.x / a, v.y / a, v.z / a}; }

  friend R dot(const Vector3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend R dot(const Vector3& a, const dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend R dot(const dvec3& a, const Vector3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  }
  friend Vector3 cross(const Vector3& a, const dvec3& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  }
  friend Vector3 cross(const dvec3& a, const Vector3& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  }
  friend R length(const Vector3& v) { return sqrt(dot(v, v)); }
  friend R distance(const Vector3& a, const Vector3& b) { return length(b - a); }
  /// As GLM: by the inverse root.
  friend Vector3 normalize(const Vector3& v) { return v * (1.0 / sqrt(dot(v, v))); }
};
template <int N>
Vector3<DualNumber<N>> operator*(const DualNumber<N>& a, const dvec3& v) {
  return {a * v.x, a * v.y, a * v.z};
}

/// The types that go with a real type, as listed above.
template <typename R>
struct NumberTypes;
template <>
struct NumberTypes<double> {
  using Complex = std::complex<double>;
  using Vec3 = dvec3;
  using Vec2 = dvec2;
};
template <int N>
struct NumberTypes<DualNumber<N>> {
  using Complex = DualComplexNumber<N>;
  using Vec3 = Vector3<DualNumber<N>>;
  using Vec2 = Vector2<DualNumber<N>>;
};
template <typename R>
using ComplexOf = typename NumberTypes<R>::Complex;
template <typename R>
using Vec3Of = typename NumberTypes<R>::Vec3;
template <typename R>
using Vec2Of = typename NumberTypes<R>::Vec2;
/// R as a parameter from which the compiler does not deduce R: `f(1.0)` is f<double>, and f<Dual> is asked
/// for by name.
template <typename R>
using Given = std::type_identity_t<R>;

/// Returns a number without its derivatives.
inline double value_of(double x) { return x; }
inline std::complex<double> value_of(const std::complex<double>& z) { return z; }
inline const dvec3& value_of(const dvec3& v) { return v; }
template <int N>
double value_of(const DualNumber<N>& x) {
  return x.value;
}
template <int N>
std::complex<double> value_of(const DualComplexNumber<N>& z) {
  return z.value();
}
inline const dvec2& value_of(const dvec2& v) { return v; }
template <typename R>
dvec2 value_of(const Vector2<R>& v) {
  return {value_of(v.x), value_of(v.y)};
}
template <typename R>
dvec3 value_of(const Vector3<R>& v) {
  return {value_of(v.x), value_of(v.y), value_of(v.z)};
}

/// Tells whether a number is 0 and stays 0 whatever the parameters.
inline bool always_zero(double x) { return x == 0.0; }
inline bool always_zero(const std::complex<double>& z) { return z == 0.0; }
template <int N>
bool always_zero(const DualNumber<N>& x) {
  return x.value == 0.0 && x.constant();
}
template <int N>
bool always_zero(const DualComplexNumber<N>& z) {
  return always_zero(z.re) && always_zero(z.im);
}

/// Returns r e^{j phi}.
template <int N>
DualComplexNumber<N> polar(const DualNumber<N>& radius, const DualNumber<N>& angle) {
  const std::complex<double> direction = std::polar(1.0, angle.value);
  const std::complex<double> value = std::polar(radius.value, angle.value);
  return {DualNumber<N>::joined(value.real(), radius, direction.real(), angle, -value.imag()),
          DualNumber<N>::joined(value.imag(), radius, direction.imag(), angle, value.real())};
}

/// The dual number that the library's physics is built for.
using Dual = DualNumber<4>;
using DualComplex = ComplexOf<Dual>;

}  // namespace greatx
