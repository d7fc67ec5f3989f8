// SPDX-License-Identifier: MIT
// Any domain. The falloff is elliptical: distance is measured in uv, 1 at the corner.

// x^k for x from 0 to 1 and k above 0. Half of what a software driver does for pow() is for what cannot be here. Fitted by
// Remez exchange: log2 of the mantissa, from sqrt(1/2) to sqrt(2), within 2.2e-6, and exp2 of the fraction within 2.7e-6, both
// exact at 1.
float vignette_power(float x, float k) {
    if (!is_software) return pow(x, k);
    int bits = floatBitsToInt(x), exponent = (bits - 0x3f3504f3) >> 23;
    float t = intBitsToFloat(bits - (exponent << 23)) - 1.0, tt = t * t;
    float logarithm = float(exponent) + t * ((1.44271348 - 0.721131859 * t) +
                                             tt * ((0.479348018 - 0.367489969 * t) + tt * (0.322154810 - 0.206591797 * t)));
    float y = max(k * logarithm, -126.0), whole = floor(y + 0.5), f = y - whole, ff = f * f;
    float power = (1.0 + 0.693121529 * f) + ff * ((0.240220210 + 0.0559196884 * f) + ff * 0.00968190941);
    return x > 0.0 ? intBitsToFloat(floatBitsToInt(power) + (int(whole) << 23)) : 0.0;
}

vec4 vignette(vec4 color, Pixel pixel, Vignette parameters) {
    vec2 offset = pixel.uv - 0.5;
    float squared = 2.0 * dot(offset, offset);
    // d^s = (d^2)^(s/2): saves the square root.
    float falloff = vignette_power(squared, 0.5 * parameters.smoothness);
    return vec4(color.rgb * clamp(1.0 - falloff * parameters.intensity, 0.0, 1.0), color.a);
}
