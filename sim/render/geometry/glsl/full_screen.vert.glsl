// One triangle that covers the film, at the depth of the class that is drawn.
uniform float classDepth = 0.5;
// The summand changes nothing: lavapipe 22.3 writes beyond its stack where an output is a uniform alone.
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, classDepth + 1.0e-30 * float(gl_VertexID), 1.0); }
