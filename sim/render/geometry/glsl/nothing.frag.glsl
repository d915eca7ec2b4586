// Counts as seen, and leaves no trace.
void main() {}
