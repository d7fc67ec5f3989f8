// SPDX-License-Identifier: MIT
// What is left to blur of a circle where the passes blur by themselves, as one whose radius has the square `own`, in texels.
// Of large circles their variances are subtracted; small ones stay apart.
float depth_of_field_left(float radius, float own) { return radius * radius * inversesqrt(radius * radius + own); }
