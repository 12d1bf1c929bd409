"""The problem of tests/bench/size.c by GetFEM: a body on a rough floor, pressed
and sheared by its top, Coulomb friction of 0.3, node by node with multipliers.

    getfem_contact.py MESH.msh

Prints the normal force of the floor."""
import sys

import getfem as gf
import numpy as np

E, NU, MU = 1.0, 0.3, 0.3

gf.util_trace_level(1)
mesh = gf.Mesh("import", "gmsh", sys.argv[1])
dim = mesh.dim()
points = mesh.pts()
up = dim - 1
faces = mesh.outer_faces()
top = points[up].max()


def flat(height):
    """Outer faces whose nodes all have that height."""
    keep = []
    for k in range(faces.shape[1]):
        ids = mesh.pid_in_faces(faces[:, [k]])
        keep.append(np.all(abs(points[up, ids] - height) < 1e-9))
    return faces[:, keep]


mesh.set_region(1, flat(0.0))
mesh.set_region(2, flat(top))
space = gf.MeshFem(mesh, dim)
space.set_classical_fem(1)
integral = gf.MeshIm(mesh, 2)

model = gf.Model("real")
model.add_fem_variable("u", space)
model.add_initialized_data("lambda", E * NU / ((1 + NU) * (1 - 2 * NU)))
model.add_initialized_data("mu", E / (2 * (1 + NU)))
model.add_isotropic_linearized_elasticity_brick(integral, "u", "lambda", "mu")
move = np.zeros(dim)
move[0], move[up] = 0.0015, -0.004
model.add_initialized_data("move", move)
model.add_Dirichlet_condition_with_simplification("u", 2, "move")

dofs = space.basic_dof_on_region(1)
nodes = space.basic_dof_nodes(dofs)
first = dofs[::dim]
n = len(first)
x = nodes[:, ::dim]
gap = 0.002 * (1 + np.cos(6.283 * x[0] + 1) *
               (np.cos(6.283 * x[1]) if dim == 3 else 1)) + \
    0.001 * (1 + np.cos(31.4 * x[0]))
BN = gf.Spmat("empty", n, space.nbdof())
BT = gf.Spmat("empty", n * (dim - 1), space.nbdof())
for i, d in enumerate(first):
    BN.add(i, int(d) + up, -1.0)
    for k in range(dim - 1):
        BT.add(i * (dim - 1) + k, int(d) + k, 1.0)
model.add_variable("ln", n)
model.add_variable("lt", n * (dim - 1))
model.add_initialized_data("r", [E])
model.add_initialized_data("gap", gap)
model.add_initialized_data("alpha", np.ones(n))
model.add_initialized_data("friction", [MU])
model.add_basic_contact_brick("u", "ln", "lt", "r", BN, BT, "friction", "gap",
                              "alpha", 1)
if not model.solve("max_res", 1e-9, "max_iter", 200)[1]:
    raise SystemExit("no convergence")
print(abs(model.variable("ln").sum()))
