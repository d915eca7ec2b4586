layout(location = 0) out uvec2 identity;  // draw (0 is the background), triangle
uniform int firstTriangle;
//@slot drawn

void main() { identity = uvec2(uint(drawIndex), uint(firstTriangle + gl_PrimitiveID)); }
