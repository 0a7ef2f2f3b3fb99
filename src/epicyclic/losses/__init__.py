"""Loss models: geometry, loads, speeds and oil in, watts and their explanation out.

==================  ===========================================================================
module              what it computes
==================  ===========================================================================
`contact`           local conditions along the contact lines of a mesh
`load_distribution` load along the contact lines
`friction`          coefficient of sliding friction, one model a class
`rolling`           rolling loss per contact length
`mesh`              sliding and rolling loss of a mesh, locally or by a loss factor
`planet_bearing`    load on every roller slice, rolling loss
`viscous`           viscous loss of bearings, drag of gears and carrier
`validity`          ranges of the models, and what leaves them
==================  ===========================================================================
"""
