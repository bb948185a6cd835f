"""
A block on an incline: Coulomb's angle
======================================

A block lies on a plane with μ = 0.3 and gravity is turned by a slope. Below the angle of
friction, tan α = 0.3, it stays; above it, it slides with a = g (sin α − μ cos α).
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np

import carom

FRICTION, GRAVITY = 0.3, 9.81


def slide(slope: float) -> carom.Result:
    """Run the block for 0.6 s; damping lets the vibration of its sudden loading fade."""
    stiff = carom.SaintVenantKirchhoff(
        young=1e8, poisson=0.3, density=1000.0, damping=carom.Damping(stiffness=5e-4)
    )
    block = carom.Body(
        name="block",
        material="stiff",
        mesh=carom.Rectangle(corner=[-0.5, 0.0], size=[1.0, 0.5], divisions=[4, 2]),
    )
    pull = [GRAVITY * np.sin(slope), -GRAVITY * np.cos(slope)]
    scenario = carom.Scenario(
        title="Incline",
        analysis=carom.Dynamic(
            end_time=0.6,
            time_step=1e-3,
            gravity=pull,
            scheme=carom.Theta(theta=0.6, xi=0.6),
        ),
        output=carom.Output(fields_every=0.05),
        materials={"stiff": stiff},
        bodies=[block],
        obstacles=[carom.Plane(name="plane", point=[0.0, 0.0], normal=[0.0, 1.0])],
        contact=carom.Contact(condition="gap", friction=FRICTION),
    )
    return carom.run(scenario, out=mkdtemp())


# %%
# Velocities along the slope, and the exact ones of a rigid block.

figure, axes = plt.subplots(layout="constrained")
for degrees in (10.0, 16.0, 20.0, 25.0):
    slope = np.radians(degrees)
    result = slide(slope)
    time, velocity = result.history["time"], result.history["block.v_x"]
    exact = max(0.0, GRAVITY * (np.sin(slope) - FRICTION * np.cos(slope)))
    late = time >= 0.3
    found = round(np.polyfit(time[late], velocity[late], 1)[0], 5) + 0.0  # never -0
    print(f"{degrees:.0f}°: {found:.5f} m/s², exact {exact:.5f} m/s²")
    (line,) = axes.plot(time, velocity, label=f"{degrees:.0f}°")
    axes.plot(time, exact * time, ":", color=line.get_color())
axes.set_xlabel("time [s]")
axes.set_ylabel("velocity down the slope [m/s]; dotted: exact")
axes.legend(title=f"friction angle {np.degrees(np.arctan(FRICTION)):.1f}°")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/incline.png'
