"""The state of a simulation as numpy arrays in SI.

An array shows the instant at which it was taken, and stays valid. Arrays are read-only and, where the simulation holds them, without a
copy: those that are still used when the simulation goes on keep the memory, and the simulation continues in a copy.
"""

from collections import namedtuple
from collections.abc import Mapping

import numpy

from .errors import Error, UnknownName


def _column(name, doc):
    return property(lambda self: self._read(name), doc=doc)


class Bodies:
    """All bodies, one row each. The row of a body may change in any step, its `id` never does."""

    def __init__(self, core):
        self._core, self._read = core, core.body_column

    id = _column("id", "number that the body keeps for the whole run")
    position = _column("position", "centres [m], n × 3")
    radius = _column("radius", "m")
    velocity = _column("velocity", "m/s, n × 3, half a step before `time`")
    spin = _column("spin", "angular velocity [rad/s], n × 3, right-handed, half a step before `time`")
    material = _column("material", "index of `materials`")
    force = _column("force", "net force of gravity and contacts [N], n × 3, before damping; 0 along axes that engines hold")
    moment = _column("moment", "net moment [N m], n × 3")

    def __len__(self):
        return self._core.bodies

    def __repr__(self):
        return f"<{len(self)} bodies>"

    @property
    def mass(self):
        """kg, with density scaling; of a body of a clump, the mass of the clump. A copy."""
        return 1 / self._read("inverse_mass")

    def _kept(self, name):
        rows = self._read(name)
        if len(rows) < len(self):
            raise Error(f"the {name} of bodies is not kept; open the simulation with keep=[\"{name}\"]")
        return rows

    @property
    def rotation(self):
        """Cumulative since the start of the stage [rad], n × 3. Needs keep=["rotation"]."""
        return self._kept("rotation")

    @property
    def displacement(self):
        """Since the start of the stage [m], n × 3. Needs keep=["displacement"]."""
        return self._kept("displacement")

    @property
    def materials(self):
        """Names, by the index in `material`."""
        return self._core.material_names()

    @property
    def group(self):
        """The name of each body's group. A copy."""
        groups = self._core.groups()
        first, names = [first for first, _ in groups], numpy.array([name for _, name in groups])
        return names[numpy.searchsorted(first, self.id, side="right") - 1]

    @property
    def clump(self):
        """Id of the clump that each body is part of, -1 for a single body. A copy."""
        of, ids = self._read("clump_of"), self._core.clump_column("id")
        if not len(of):
            return numpy.full(len(self), -1)
        return numpy.where(of < len(ids), ids.astype(int)[numpy.minimum(of, len(ids) - 1)], -1)

    def rows_of(self, ids):
        """Rows of the bodies with these ids, at this instant: `position[rows_of(ids)]` follows bodies. Raises KeyError for a body that left."""
        now, wanted = self.id, numpy.asarray(ids)
        if wanted.size and wanted.dtype.kind not in "iu":
            raise TypeError(f"ids: found {ids!r}; allowed is a whole number, or a list of them")
        order = numpy.argsort(now)
        place = numpy.minimum(numpy.searchsorted(now, wanted, sorter=order), len(now) - 1)
        rows = order[place] if len(now) else place
        missing = wanted != now[rows] if len(now) else numpy.ones(wanted.shape, bool)
        if missing.any():
            raise KeyError(f"there is no body with the id {wanted[missing].flat[0]}")
        return rows


class Clumps:
    """Rigid clumps of spheres, one row each. Their spheres are bodies, too."""

    def __init__(self, core):
        self._core, self._read = core, core.clump_column

    id = _column("id", "number that the clump keeps")
    centre = _column("centre", "of mass [m], n × 3")
    velocity = _column("velocity", "m/s, n × 3, half a step before `time`")
    spin = _column("spin", "angular velocity [rad/s], n × 3, half a step before `time`")
    angular_momentum = _column("angular_momentum", "about the centre [kg m²/s], n × 3, half a step before `time`")
    force = _column("force", "net, of gravity and contacts [N], n × 3")
    moment = _column("moment", "net, about the centre [N m], n × 3")
    radius = _column("radius", "of the enclosing sphere [m]")
    mass = _column("mass", "kg")
    axes = _column("axes", "principal axes, n × 3 × 3; columns are axes")
    inertia = _column("inertia", "principal moments of inertia [kg m²], n × 3")

    def __len__(self):
        return len(self.id)

    def __repr__(self):
        return f"<{len(self)} clumps>"


class Contacts:
    """All contacts of bodies, then those with walls, one row each."""

    def __init__(self, core):
        self._core, self._read = core, core.contact_column

    a = _column("a", "row of the first body in `bodies`")
    b = _column("b", "row of the second body; index of the wall for a contact with a wall")
    with_wall = _column("with_wall", "whether the contact is with a wall")
    feature = _column("feature", "part of the wall in contact, numbered by its geometry; 0 between bodies")
    branch = _column("branch", "from the centre of a to that of b, or to the contact point on the wall [m], n × 3")
    normal = _column("normal", "unit vector from a to b, n × 3")
    force = _column("force", "on b [N], n × 3; the opposite acts on a")
    moment = _column("moment", "on b about its centre, on a wall about the contact point [N m], n × 3")
    normal_force = _column("normal_force", "N, positive in compression")
    overlap = _column("overlap", "m; negative where a law acts at a distance")

    def __len__(self):
        return len(self.a)

    def __repr__(self):
        return f"<{len(self)} contacts>"

    @property
    def body_a(self):
        """Id of the first body. A copy."""
        return self._core.body_column("id")[self.a].astype(numpy.int64)

    @property
    def body_b(self):
        """Id of the second body; -1 - index of the wall for a wall. A copy."""
        ids, b, walls = self._core.body_column("id"), self.b.astype(numpy.int64), self.with_wall
        found = -1 - b
        found[~walls] = ids[b[~walls]]
        return found


class Departures:
    """Bodies that left the domain, in order of time."""

    def __init__(self, core):
        self._core, self._read = core, core.departure_column

    id = _column("id", "of the body")
    material = _column("material", "index of `bodies.materials`")
    time = _column("time", "when it was found outside [s]")
    mass = _column("mass", "without density scaling [kg]")
    position = _column("position", "at that time [m], n × 3")

    def __len__(self):
        return len(self.id)

    def __repr__(self):
        return f"<{len(self)} bodies that left>"


def _value(name, doc):
    return property(lambda self: self._core.wall(self.index)[name], doc=doc)


class Wall:
    """A wall. Its values are those of the present instant, as copies."""

    def __init__(self, core, index, name):
        self._core, self.index, self.name = core, index, name

    position = _value("position", "displacement since the start of the run [m]")
    stage_position = _value("stage_position", "displacement since the start of the stage [m]")
    velocity = _value("velocity", "m/s")
    spin = _value("spin", "angular velocity [rad/s]")
    force = _value("force", "by the bodies on the wall [N]")
    moment = _value("moment", "the same about the wall's reference point [N m]")
    normal = _value("normal", "mean unit normal, towards the bodies; 0 where the geometry has none")
    area = _value("area", "m²; 0 where the geometry has none")
    pressure = _value("pressure", "normal force over area, positive in compression [Pa]")
    contacts = _value("contacts", "number of contacts")

    def __repr__(self):
        return f"<wall {self.name!r}>"


class Walls(Mapping):
    """Walls by name."""

    def __init__(self, core):
        self._core, self._names = core, core.walls()

    def __getitem__(self, name):
        if name not in self._names:
            raise UnknownName("wall", name, self._names)
        return Wall(self._core, self._names.index(name), name)

    def __iter__(self):
        return iter(self._names)

    def __len__(self):
        return len(self._names)

    def __repr__(self):
        return f"<walls: {', '.join(self)}>"


Cell = namedtuple("Cell", "low high periodic strain_rate shear_rate tilt")
Cell.__doc__ = "The box of the domain [m], infinite along open sides; rates [1/s]; offsets of images of a sheared cell [m]: xy, xz, yz."

Energies = namedtuple("Energies", "kinetic elastic_normal elastic_shear elastic_rolling gravitational walls cell engines settings friction rolling viscosity "
                                  "local_damping closure_error")
Energies.__doc__ = "Energy balance [J]: stored energies; work of walls, cell, engines and settings; dissipation; the error of the balance."
