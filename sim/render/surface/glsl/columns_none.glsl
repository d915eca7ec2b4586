// No light asks for reflection columns.
