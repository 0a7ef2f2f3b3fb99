"""Loss from squeezing oil and air out of the tooth spaces of a mesh."""
