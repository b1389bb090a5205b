"""What the scripts of bench/ share: the machine, packings, runs of grit and of other codes, bounds."""
