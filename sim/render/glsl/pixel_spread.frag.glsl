//@constants
// Subpixels get what their pixel has.
//@slot spread
