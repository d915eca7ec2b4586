// A scene without ground: rays that meet no body go on.
float groundDepth() { return kFar; }
