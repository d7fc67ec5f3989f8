// SPDX-License-Identifier: MIT
// SMPTE ST 2084:2014, with light 1.0 for 10000 cd/m2.
#ifndef SHARED_PQ
#define SHARED_PQ
// log2 of the curve's ratio is taken by the series of 2 atanh(z), with z the ratio's (r - 1) / (r + 1): |z| < 0.09, so three
// terms reach single precision, which log2 itself does not on all devices, and the exponent 78.84 would multiply its error.
vec3 pq_encode(vec3 light) {
    vec3 y = pow(light, vec3(2610.0 / 16384.0));
    // c1 = 107/128, c2 = 2413/128, c3 = 2392/128
    vec3 z = (y - 1.0) * (21.0 / 128.0) / (235.0 / 128.0 + y * (4805.0 / 128.0));
    vec3 zz = z * z;
    vec3 log2_ratio = z * (2.0 / 0.69314718056) * (1.0 + zz * (1.0 / 3.0 + zz * (1.0 / 5.0)));
    return exp2((2523.0 / 32.0) * log2_ratio);
}
// Of y = code^(32/2523), which is near 1, the distance d = y - 1 counts: near the peak light changes by 7e2 times what y does.
// d is taken by the series of exp(x) - 1; |x| < 0.18 where there is light, and six terms reach single precision.
vec3 pq_decode(vec3 code) {
    vec3 x = log2(clamp(code, 7.3e-7, 1.0)) * (0.69314718056 * 32.0 / 2523.0);
    vec3 d = x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0))))));
    return pow(max(21.0 / 128.0 + d, 0.0) / (21.0 / 128.0 - (2392.0 / 128.0) * d), vec3(16384.0 / 2610.0));
}
#endif
