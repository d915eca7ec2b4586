// No light asks for reflection columns.
void prepareLobes() {}
