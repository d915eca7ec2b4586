// A scene without ground: nothing ends a line of sight but bodies.
bool hiddenByGround(float range) { return false; }
