// A source that any compiler accepts.
#ifndef TAPPET_EFFECTS_CHECKED
#error "the build does not check this source"
#endif

int plain() { return 0; }
