// The draw that the vertex stage found for the instance.
flat in uint drawIndex;
