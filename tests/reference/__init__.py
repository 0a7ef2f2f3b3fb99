"""Closed-form solutions from the literature, against which the models of the package are checked.

They share no code with the loss models: each one stands on its own, with its source, and can be
used to check another program as well. All in SI units, angles in radians.

=================  ============================================================================
module             solutions
=================  ============================================================================
`gear_loss`        loss factor of a mesh with constant friction
`line_contact`     Hertz contact of two cylinders
`mesh_stiffness`   stiffness of a mesh after ISO 6336-1
`planetary`        efficiency of a planetary set from the loss of its meshes
`roller_bearing`   load distribution of a roller bearing without misalignment
`rotating_body`    power to turn a disc or a cylinder in a fluid at rest
=================  ============================================================================
"""
