"""What the scripts of bench/ share: the machine, packings, runs of grit, runs of its peers, bounds."""
