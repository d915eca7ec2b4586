// One body a draw.
uniform int drawIndex;
int drawnHere() { return drawIndex; }
