// What every program knows of the view. Not a block of uniforms: lavapipe 22.3 writes beyond its stack where it takes one of their values for a constant.
layout(binding = 29) uniform samplerBuffer viewTexels;
struct View {
  vec4 pixel;     // tangent per pixel x, y; film position of the axis (pixels from the lower left)
  vec4 film;      // 2 / (width tanX), 2 / (height tanY), clip offset x, y
  vec4 depth;     // near [m]; 0: reversed depth near / z, or the scale of depth around a body's centre; first of its draws in the buffer
  vec4 up;        // local up in the camera frame; height of the camera [m]
  vec4 earth;     // earth radius, top of the air [m]; the entity + 1 to be shaded alone, or 0: all and the background
  vec4 sun;       // direction of the sun in the camera frame
  vec4 aperture;  // aperture area [m2], (pitch / focal length)^2 of a whole pixel
  vec4 east;      // local east and north in the camera frame (for truth normals)
  vec4 north;
};
View view = View(texelFetch(viewTexels, 0), texelFetch(viewTexels, 1), texelFetch(viewTexels, 2), texelFetch(viewTexels, 3), texelFetch(viewTexels, 4),
                 texelFetch(viewTexels, 5), texelFetch(viewTexels, 6), texelFetch(viewTexels, 7), texelFetch(viewTexels, 8));
