// In the two upper bits of a hit's first number, its draw below; what follows:
//   a pane (t, -, triangle), a medium (t entering, t leaving, -), a border of a meshed medium (t, 1: leaving it, triangle), a field (t of its near end,
//   of its far one, -). t: along the line from the plane of the draw's origin.
const uint kPane = 0u, kMedium = 1u, kBorder = 2u, kField = 3u;
