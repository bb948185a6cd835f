"""
A wall of loose bricks is hit
=============================

A heavy ball flies into a wall of bricks that nothing but weight and friction hold. What the ball
brings goes into bricks that fly, and into friction and impacts among those that stay.
"""

from tempfile import mkdtemp

import matplotlib.pyplot as plt
from pictures import draw

import carom

LENGTH, HEIGHT, COURSES, COLUMNS = 0.2, 0.1, 8, 3
bricks = [
    carom.RigidBody(
        name=f"brick-{course}-{column}",
        density=2000.0,
        mesh=carom.Rectangle(
            corner=[LENGTH * (column + 0.5 * (course % 2)), HEIGHT * course],
            size=[LENGTH, HEIGHT],
            divisions=[2, 1],
        ),
    )
    for course in range(COURSES)
    for column in range(COLUMNS)
]
ball = carom.RigidBody(
    name="ball",
    density=7800.0,
    mesh=carom.Disc(centre=[-0.25, 0.45], radius=0.12, divisions=8),
    velocity=[6.0, 0.0],
    round=True,
)
scenario = carom.Scenario(
    title="A wall is hit",
    analysis=carom.Dynamic(end_time=0.5, time_step=1e-3, gravity=[0.0, -9.81]),
    output=carom.Output(fields_every=0.01),
    bodies=[*bricks, ball],
    obstacles=[carom.Plane(name="ground", point=[0.0, 0.0], normal=[0.0, 1.0])],
    contact=carom.Contact(condition="endpoint", friction=0.5),
)
result = carom.run(scenario, out=mkdtemp())
history, energy = result.history, result.summary["energy"]
brought = history["kinetic"][0]
print(f"the ball brought {brought:.0f} J, gravity gave {history['external'][-1]:.0f} J")
print(
    f"friction took {history['friction'][-1]:.0f} J, impacts {history['normal_contact'][-1]:.0f} J"
)
print(f"{history['kinetic'][-1]:.0f} J still move; not explained: {energy['max_defect']:.0e} J")

draw(result, [0.0, 0.1, 0.25, 0.5], field="body")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/wall.png'
