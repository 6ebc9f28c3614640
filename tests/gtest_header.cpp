// Stands for the precompiled header of GoogleTest, which a target must own.
