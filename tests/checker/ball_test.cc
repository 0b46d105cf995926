// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the checker's numbers, in the way of the tests of IEEE 1788 (ITF1788): a result holds the exact range over
// the operands, found by MPFR alone to 2100 bits (tests/support/interval_operations.h), and is Undefined wherever some
// member of the operands is outside of the domain.
//
// TAUT_INTERVAL_CASES=N: random cases an operation (the slow suite).
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "checker/kernel/linear.h"
#include "tests/support/checker_enclosing.h"
#include "tests/support/interval_operations.h"

namespace taut::testing {
namespace {

using checker::Ball;
using checker::MeanValueForm;
using checker::Undefined;
using checker::WorkingPrecision;

template <class A>
class BallLaws : public ::testing::Test {
 protected:
  template <class Op>
  void expect_enclosure(const Operand& a, const Operand& b) {
    if (failures_ > 20) return;
    const auto fail = [&](const std::string& what) {
      if (++failures_ <= 5) ADD_FAILURE() << what << ": " << Op::kName << " at " << hex(a) << ", " << hex(b);
    };
    Ball result;
    const bool defined = A::run([&] { result = Op::apply(A::make(a), A::make(b)); });
    ++cases_;
    if (defined) ++defined_;
    const PrecisionScope precision(kOracleBits);
    if (std::is_same_v<Op, Angle> && a.lower == 0 && a.upper == 0 && b.upper < 0) {  // on the cut
      // The ball of a wide operand may reach beyond 0.
      if (!defined ? b.thin() : !holds(result, ScalarTraits<BigFloat>::pi())) fail("not pi");
      return;
    }
    if (!Op::defined(a, b)) {
      if (defined) fail("undefined for a member, yet there is a result");
      return;
    }
    // There MPFR overflows, where a ball does not.
    if (std::is_same_v<Op, Exponential> && std::max(std::abs(a.lower), std::abs(a.upper)) > 1e8) return;
    const Range range = Op::range(a, b);
    if (!defined) {
      // The ball of a wide operand holds numbers beyond its ends; that of a single number is the number.
      const bool is_plain = a.thin() && (Op::kOperands == 1 || b.thin()) && !extreme(a) && !extreme(b) &&
                            !extreme(range.lower) && !extreme(range.upper);
      // With 32 bits 1 - x^2 of a binary64 next to 1 may enclose 0.
      const bool is_coarse = std::is_same_v<A, Checker<32>>;
      if (is_plain && !Op::kMayGiveUp && !is_coarse) fail("undefined within the domain");
      return;
    }
    if (!(lower_end(result) <= range.lower && range.upper <= upper_end(result))) {
      fail("the range from " + digits(range.lower) + " to " + digits(range.upper) + " is not in " + print(result));
    }
  }

  template <class Op>
  void expect_enclosures() {
    Operands operands(20261121);
    cases_ = defined_ = failures_ = 0;
    for (int n = 0; n < random_cases(); ++n) {
      const Operand a = random_operand<Op>(operands);
      expect_enclosure<Op>(a, Op::kOperands == 2 ? operands.interval() : a);
    }
    EXPECT_GT(defined_, cases_ / 8) << Op::kName;
    const std::vector<Operand>& directed = directed_operands();
    for (std::size_t i = 0; i < directed.size(); ++i) {
      if (Op::kOperands == 1) expect_enclosure<Op>(directed[i], directed[i]);
      for (std::size_t k = i % 37; Op::kOperands == 2 && k < directed.size(); k += 37) {
        expect_enclosure<Op>(directed[i], directed[k]);
      }
    }
  }

  int failures_ = 0;
  int cases_ = 0;
  int defined_ = 0;
};

using Precisions = ::testing::Types<Checker<32>, Checker<64>, Checker<128>, Checker<512>>;
struct PrecisionNames {
  template <class A>
  static std::string GetName(int) {
    return "Bits" + std::to_string(A::kBits);
  }
};
TYPED_TEST_SUITE(BallLaws, Precisions, PrecisionNames);

TYPED_TEST(BallLaws, OperationsEncloseTheirRange) {
  for_each_operation([&]<class Op>() { this->template expect_enclosures<Op>(); });
}

TYPED_TEST(BallLaws, QuestionsAreAnsweredForEveryMember) {
  using A = TypeParam;
  Operands operands(8);
  EXPECT_TRUE(A::run([&] {
    for (int n = 0; n < 3000; ++n) {
      const Operand x = n < static_cast<int>(directed_operands().size())
                            ? directed_operands()[static_cast<std::size_t>(n)]
                            : operands.interval();
      const Operand y = operands.interval();
      const Ball a = A::make(x);
      const Ball b = A::make(y);
      const PrecisionScope precision(kOracleBits);
      const BigFloat low = lower_end(a), high = upper_end(a);
      const BigFloat zero(0.0);
      const BigFloat size = abs(low) > abs(high) ? abs(low) : abs(high);
      // The end itself may be rounded where it is asked for: never to the unsafe side.
      EXPECT_TRUE(!certainly_positive(a) || low > zero) << hex(x);
      EXPECT_TRUE(!certainly_negative(a) || high < zero) << hex(x);
      EXPECT_TRUE(!certainly_nonnegative(a) || low >= zero) << hex(x);
      if (x.thin()) {
        EXPECT_EQ(certainly_positive(a), x.lower > 0) << hex(x);
        EXPECT_EQ(certainly_negative(a), x.lower < 0) << hex(x);
        EXPECT_EQ(certainly_nonnegative(a), x.lower >= 0) << hex(x);
        EXPECT_EQ(a.is_zero(), x.lower == 0) << hex(x);
      }
      EXPECT_TRUE(!is_within(a, b) || (lower_end(b) <= low && high <= upper_end(b))) << hex(x) << hex(y);
      EXPECT_TRUE(is_within(a, a)) << hex(x);
      EXPECT_TRUE(lower_end(highest(a)) == upper_end(highest(a)) && lower_end(highest(a)) >= high) << hex(x);
      EXPECT_TRUE(lower_end(lowest(a)) == upper_end(lowest(a)) && upper_end(lowest(a)) <= low) << hex(x);
      EXPECT_TRUE(lower_end(magnitude(a)) == upper_end(magnitude(a)) && lower_end(magnitude(a)) >= size) << hex(x);
      const BigFloat least = upper_end(least_magnitude(a));
      EXPECT_TRUE(least <= abs(low) && least <= abs(high) && (low * high > zero || least == zero)) << hex(x);
      EXPECT_TRUE(is_within(middle(a), a)) << hex(x);
      EXPECT_TRUE(lower_end(middle(a)) == upper_end(middle(a))) << hex(x);
      const Ball both = hull(a, b);
      EXPECT_TRUE(lower_end(both) <= low && high <= upper_end(both)) << hex(x) << hex(y);
      EXPECT_TRUE(lower_end(both) <= lower_end(b) && upper_end(b) <= upper_end(both)) << hex(x) << hex(y);
      const Ball wide = plus_minus(b, a);
      EXPECT_TRUE(lower_end(wide) <= lower_end(b) - size && upper_end(b) + size <= upper_end(wide)) << hex(x) << hex(y);
      EXPECT_TRUE(is_within(a, plus_minus(a)) && is_within(-a, plus_minus(a)) && is_within(Ball(), plus_minus(a)));
      const Ball up_to = checker::from_zero_to(a);
      EXPECT_TRUE(is_within(a, up_to) && is_within(Ball(), up_to)) << hex(x);
      const Ball p = magnitude(a), q = magnitude(b);
      const Ball& most = larger(p, q);
      EXPECT_TRUE(lower_end(most) >= lower_end(p) && lower_end(most) >= lower_end(q)) << hex(x) << hex(y);
    }
  }));
}

TYPED_TEST(BallLaws, SumsInPlaceHoldWhatTheSumHolds) {
  using A = TypeParam;
  Operands operands(9);
  for (int n = 0; n < 2000; ++n) {
    const Operand x = operands.interval(), y = operands.interval(), z = operands.interval();
    Ball sum, difference, product, less;
    if (!A::run([&] {
          sum = difference = product = less = A::make(x);
          sum += A::make(y);
          difference -= A::make(y);
          product.add_product(A::make(y), A::make(z));
          less.subtract_product(A::make(y), A::make(z));
        })) {
      continue;
    }
    const PrecisionScope precision(kOracleBits);
    const BigFloat a(operands.inside(x)), b(operands.inside(y)), c(operands.inside(z));
    EXPECT_TRUE(holds(sum, a + b)) << hex(x) << hex(y);
    EXPECT_TRUE(holds(difference, a - b)) << hex(x) << hex(y);
    EXPECT_TRUE(holds(product, a + b * c)) << hex(x) << hex(y) << hex(z);
    EXPECT_TRUE(holds(less, a - b * c)) << hex(x) << hex(y) << hex(z);
  }
}

TYPED_TEST(BallLaws, SumsOfProductsHoldWhatTheSumHolds) {
  using A = TypeParam;
  using Vector = checker::Vector3<Ball>;
  Operands operands(10);
  for (int n = 0; n < 2000; ++n) {
    std::array<Operand, 6> x;
    std::array<std::array<Operand, 3>, 6> y;
    for (Operand& entry : x) entry = operands.interval();
    for (auto& row : y) {
      for (Operand& entry : row) entry = operands.interval();
    }
    if (n % 2 == 0) {  // products that nearly cancel
      for (std::size_t i = 0; i < 3; ++i) {
        x[i + 3] = {-x[i].upper, -x[i].lower};
        y[i + 3] = y[i];
      }
    }
    checker::Vector6<Ball> a;
    std::array<Vector, 6> b;
    Vector sums, turned;
    Ball of_three, of_six;
    if (!A::run([&] {
          for (std::size_t i = 0; i < 6; ++i) {
            a[i] = A::make(x[i]);
            for (std::size_t c = 0; c < 3; ++c) b[i][c] = A::make(y[i][c]);
          }
          sums = checker::combination(a, b);
          turned = checker::cross(b[0], b[1]);
          of_three = checker::dot(b[0], b[1]);
          of_six = checker::dot(a, {b[0][0], b[1][0], b[2][0], b[3][0], b[4][0], b[5][0]});
        })) {
      continue;
    }
    const PrecisionScope precision(kOracleBits);
    const BigFloat zero(0.0);
    std::array<BigFloat, 3> of_column{zero, zero, zero};
    std::array<std::array<BigFloat, 3>, 6> v;
    for (std::size_t i = 0; i < 6; ++i) {
      const BigFloat c(operands.inside(x[i]));
      for (std::size_t k = 0; k < 3; ++k) {
        v[i][k] = BigFloat(operands.inside(y[i][k]));
        of_column[k] = of_column[k] + c * v[i][k];
      }
    }
    EXPECT_TRUE(holds(of_six, of_column[0])) << n;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
      EXPECT_TRUE(holds(sums[k], of_column[k])) << n;
      EXPECT_TRUE(holds(turned[k], v[0][p] * v[1][q] - v[0][q] * v[1][p])) << n;
    }
    EXPECT_TRUE(holds(of_three, v[0][0] * v[1][0] + v[0][1] * v[1][1] + v[0][2] * v[1][2])) << n;
  }
}

TYPED_TEST(BallLaws, BoundsAreNotBelowAndNotFarAbove) {
  using A = TypeParam;
  using checker::Bound;
  Operands operands(11);
  EXPECT_TRUE(A::run([&] {
    for (int n = 0; n < 3000; ++n) {
      const Ball x = A::make(n % 8 == 0 ? Operand{0, 0} : operands.interval()), y = A::make(operands.interval()),
                 z = A::make(operands.interval());
      const Bound a(x), b(y), c(z);
      Bound more = a, added = a;
      more.add_product(b, c);
      added += b;
      const Bound sum = a + b, product = a * b, length = hypot(a, b, c);
      const Ball widened = checker::plus_minus(x, b);
      const PrecisionScope precision(kOracleBits);
      const auto value = [](const Bound& of) { return upper_end(of.ball()); };
      const auto size = [](const Ball& of) {
        const BigFloat low = abs(lower_end(of)), high = abs(upper_end(of));
        return low > high ? low : high;
      };
      const BigFloat p = size(x), q = size(y), r = size(z);
      const BigFloat slack(1 + 0x1p-24);
      const auto is_close = [&](const BigFloat& bound, const BigFloat& exact) {
        return bound >= exact && bound <= slack * exact;
      };
      EXPECT_TRUE(is_close(value(a), p)) << n;
      EXPECT_TRUE(is_close(value(sum), p + q)) << n;
      EXPECT_TRUE(is_close(value(added), p + q)) << n;
      EXPECT_TRUE(is_close(value(product), p * q)) << n;
      EXPECT_TRUE(is_close(value(more), p + q * r)) << n;
      EXPECT_TRUE(is_close(value(length) * value(length), p * p + q * q + r * r)) << n;
      EXPECT_TRUE(lower_end(widened) <= lower_end(x) - q && upper_end(widened) >= upper_end(x) + q) << n;
      EXPECT_EQ(a <= b, value(a) <= value(b)) << n;
      EXPECT_TRUE(value(smaller(a, b)) <= value(a) && value(smaller(a, b)) <= value(b)) << n;
      EXPECT_TRUE(value(larger(a, b)) >= value(a) && value(larger(a, b)) >= value(b)) << n;
      EXPECT_TRUE(value(Bound()) == BigFloat(0.0) && value(Bound::power_of_two(-256)) == BigFloat(0x1p-256));
    }
  }));
}

TYPED_TEST(BallLaws, DecimalsEncloseTheTypedNumber) {
  using A = TypeParam;
  for (const std::string text : {"0", "-0", "0.1", "-0.0210", "1e-4", "34", "1e22", "1e-400", "-1e-320", "0.3", "1e900",
                                 "1.0000000000000001110223024625156540", "9007199254740993", "-190.5256e-3"}) {
    Ball result;
    ASSERT_TRUE(A::run([&] { result = A::from_decimal(text); }));
    const PrecisionScope precision(kOracleBits);
    BigFloat below, above;
    mpfr_set_str(below.get(), text.c_str(), 10, MPFR_RNDD);
    mpfr_set_str(above.get(), text.c_str(), 10, MPFR_RNDU);
    EXPECT_TRUE(lower_end(result) <= below && above <= upper_end(result)) << text << " gave " << print(result);
  }
}

// ---- Derivatives ----------------------------------------------------------------------------------------------------

/// What MPFR says of f, of any argument.
BigFloat by_mpfr(checker::Function f, const BigFloat& x) {
  using F = checker::Function;
  switch (f) {
    case F::kInverse: return BigFloat(1.0) / x;
    case F::kSqrt: return sqrt(x);
    case F::kSin: return sin(x);
    case F::kCos: return cos(x);
    case F::kExp: return exp(x);
    case F::kLog: return log(x);
    case F::kAsin: return asin(x);
    case F::kAcos: return acos(x);
    case F::kAtan: return atan(x);
  }
  return {};
}

TEST(Ball, DerivativesAreThoseOfTheFunctions) {
  using F = checker::Function;
  std::mt19937_64 random(3);
  const PrecisionScope oracle(600);
  const WorkingPrecision precision(64);
  const BigFloat h(0x1p-200);
  for (const F f : {F::kInverse, F::kSqrt, F::kSin, F::kCos, F::kExp, F::kLog, F::kAsin, F::kAcos, F::kAtan}) {
    const bool is_unit = f == F::kAsin || f == F::kAcos;
    const bool is_positive = f == F::kSqrt || f == F::kLog;
    for (int n = 0; n < 200; ++n) {
      const double most = is_unit ? 0.999 : 6;
      const double x = std::uniform_real_distribution<double>(is_positive ? 0.01 : -most, most)(random);
      if (f == F::kInverse && std::abs(x) < 0.01) continue;
      const BigFloat up = by_mpfr(f, BigFloat(x) + h), mid = by_mpfr(f, BigFloat(x)),
                     down = by_mpfr(f, BigFloat(x) - h);
      const BigFloat first = (up - down) / (BigFloat(2.0) * h);
      const BigFloat second = (up - BigFloat(2.0) * mid + down) / (h * h);
      // Beyond the differences' own errors, of the size of h^2 and of 2^-600 / h^2.
      const BigFloat slack(1e-40);
      EXPECT_TRUE(holds(value(f, Ball(x)), mid, slack)) << x;
      EXPECT_TRUE(holds(first_derivative(f, Ball(x)), first, slack)) << static_cast<int>(f) << " at " << x;
      EXPECT_TRUE(holds(second_derivative(f, Ball(x)), second, slack)) << static_cast<int>(f) << " at " << x;
    }
  }
}

TEST(Ball, DerivativesOfARangeHoldThoseOfItsMembers) {
  using F = checker::Function;
  Operands operands(4);
  const WorkingPrecision precision(64);
  for (const F f : {F::kInverse, F::kSqrt, F::kSin, F::kCos, F::kExp, F::kLog, F::kAsin, F::kAcos, F::kAtan}) {
    int defined = 0;
    for (int n = 0; n < 2000; ++n) {
      const bool is_unit = f == F::kAsin || f == F::kAcos;
      const double x =
          operands.uniform(is_unit ? -1 : 0.05, is_unit ? 1 : 4) * (f == F::kInverse && n % 2 == 0 ? -1 : 1);
      const double wide = std::exp(operands.uniform(-8, 0));
      const Ball whole = plus_minus(Ball(x), Ball(wide));
      try {
        const Ball all = value(f, whole), first = first_derivative(f, whole), second = second_derivative(f, whole);
        ++defined;
        for (int k = 0; k < 5; ++k) {
          const Ball at(x + wide * operands.uniform(-1, 1) * (1 - 0x1p-40));
          EXPECT_TRUE(arb_overlaps(all.get(), value(f, at).get()));
          EXPECT_TRUE(arb_overlaps(first.get(), first_derivative(f, at).get()));
          EXPECT_TRUE(arb_overlaps(second.get(), second_derivative(f, at).get()));
        }
      } catch (const Undefined&) {
      }
    }
    EXPECT_GT(defined, 200) << static_cast<int>(f);
  }
}

// ---- Edges ----------------------------------------------------------------------------------------------------------

TEST(Ball, RefusesWhatItCannotBound) {
  const Ball both = plus_minus(Ball(1));
  EXPECT_THROW((void)(Ball(1) / Ball(0)), Undefined);
  EXPECT_THROW((void)(Ball(0) / Ball(0)), Undefined);
  EXPECT_THROW((void)(Ball(1) / both), Undefined);
  EXPECT_THROW((void)sqrt(both), Undefined);
  EXPECT_THROW((void)sqrt(Ball(-1)), Undefined);
  EXPECT_THROW((void)log(Ball(0)), Undefined);
  EXPECT_THROW((void)log(both), Undefined);
  EXPECT_THROW((void)asin(Ball(1.0000000000000002)), Undefined);
  EXPECT_THROW((void)acos(plus_minus(Ball(1), Ball(0x1p-60))), Undefined);
  EXPECT_THROW((void)power(both, -2), Undefined);
  EXPECT_THROW((void)exp(exp(Ball(1000))), Undefined);
  EXPECT_THROW((void)Ball(std::numeric_limits<double>::infinity()), Undefined);
  EXPECT_THROW((void)Ball(std::numeric_limits<double>::quiet_NaN()), Undefined);
  EXPECT_THROW((void)tan(Ball::pi() / Ball(2)), Undefined);
  EXPECT_TRUE(arb_equal_si(power(Ball(0), 0).get(), 1) != 0);
}

TEST(Ball, Atan2IsUndefinedAtTheOriginAndAcrossItsCut) {
  const Ball both = plus_minus(Ball(1));
  EXPECT_THROW((void)atan2(Ball(0), Ball(0)), Undefined);
  EXPECT_THROW((void)atan2(both, both), Undefined);
  EXPECT_THROW((void)atan2(both, Ball(-1)), Undefined);
  EXPECT_THROW((void)atan2(plus_minus(Ball(0x1p-100)), Ball(-1)), Undefined);
  EXPECT_NO_THROW((void)atan2(both, Ball(1)));
  EXPECT_NO_THROW((void)atan2(Ball(1), both));
  EXPECT_NO_THROW((void)atan2(Ball(-1), both));
}

TEST(Ball, WorkingPrecisionEndsWithItsScope) {
  const int before = WorkingPrecision::bits();
  {
    const WorkingPrecision fine(512);
    EXPECT_EQ(WorkingPrecision::bits(), 512);
    EXPECT_LT(mag_get_d(arb_radref(Ball::pi().get())), 1e-150);
  }
  EXPECT_EQ(WorkingPrecision::bits(), before);
  EXPECT_GT(mag_get_d(arb_radref(Ball::pi().get())), 1e-25);
}

}  // namespace
}  // namespace taut::testing
