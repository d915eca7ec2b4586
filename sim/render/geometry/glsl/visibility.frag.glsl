layout(location = 0) out uvec2 identity;  // draw (0 is the background), triangle
flat in uint triangle;
//@slot drawn

void main() { identity = uvec2(uint(drawIndex), triangle); }
