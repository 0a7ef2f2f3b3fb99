"""Loss maps, duty cycles and warming up."""
