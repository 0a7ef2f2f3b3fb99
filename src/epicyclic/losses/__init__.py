"""Loss models: geometry, loads, speeds and oil in, watts and their explanation out.

=================  ============================================================================
module             what it computes
=================  ============================================================================
`contact`          load along the contact lines of a mesh, and the conditions there
`friction`         coefficient of sliding friction, each model a function with its entry
`rolling`          rolling loss per contact length, likewise
`fitted`           both from fits to simulated contacts of an oil
`mesh`             sliding and rolling loss of a mesh, locally or by a loss factor
`planet_bearing`   load on every roller slice, rolling loss
`shaft_bearing`    friction of catalogue bearings; `loss_table`: losses given by the user
`drag`             viscous loss of bearings, drag, churning and jets
`pocket_flow`      flow through the pockets of a mesh; `pocket_geometry`, `pocket_tables` with it
`ranges`           ranges of the models, and what leaves them
`reliability`      how well each model is known to be right
=================  ============================================================================
"""
