// SPDX-License-Identifier: MIT
// vignette_power.glsl by two polynomials, for x from 0 to 1 and k above 0 alone: infinity, NaN and a negative x, which pow()
// handles, do not occur. Fitted by Remez exchange: log2 of the mantissa, from sqrt(1/2) to sqrt(2), within 2.2e-6, and exp2
// of the fraction within 2.7e-6, both exact at 1.
float vignette_power(float x, float k) {
    int bits = floatBitsToInt(x), exponent = (bits - 0x3f3504f3) >> 23;
    float t = intBitsToFloat(bits - (exponent << 23)) - 1.0, tt = t * t;
    float logarithm = float(exponent) + t * ((1.44271348 - 0.721131859 * t) +
                                             tt * ((0.479348018 - 0.367489969 * t) + tt * (0.322154810 - 0.206591797 * t)));
    float y = max(k * logarithm, -126.0), whole = floor(y + 0.5), f = y - whole, ff = f * f;
    float power = (1.0 + 0.693121529 * f) + ff * ((0.240220210 + 0.0559196884 * f) + ff * 0.00968190941);
    return x > 0.0 ? intBitsToFloat(floatBitsToInt(power) + (int(whole) << 23)) : 0.0;
}
