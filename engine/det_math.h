#pragma once
// Trigonometry and powers from + − × ÷ √ in a written order, so that every compiler and CPU gives
// the same bits. Angles that are animated are given in turns where that makes them exact.

namespace still::det {

/// sin and cos of an angle in turns (1 = 360°); exact at multiples of a quarter turn, odd/even
/// symmetric to the bit, absolute error < 1e-15. Any finite argument.
double sinTurns(double turns);
double cosTurns(double turns);

/// tan of an angle in degrees, |degrees| < 90.
double tanDegrees(double degrees);

/// x^y for x ≥ 0 and finite y; relative error < 1e-12. pow(0, y > 0) is 0.
double pow(double x, double y);

/// sRGB-encoded 0 … 1 to linear light (IEC 61966-2-1).
double linearFromSrgb(double value);

}  // namespace still::det
