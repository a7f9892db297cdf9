# room.gd: a saved room in Godot: its mesh with collision, the live camera picture behind, and a pot that falls onto
# the real table by roomradar's contacts.
#
# usage: godot3-runner --path FOLDER -- MAP RECORDING [SHOTS]    SHOTS: folder for three pictures; then quits
extends Spatial

const Library = preload("res://roomradar.gdns")

# Surfaces that show the camera's picture where they are: they hide what is behind them, and nothing else.
const PICTURE_SHADER = """
shader_type spatial;
render_mode unshaded, cull_disabled, shadows_disabled;
uniform sampler2D picture : hint_albedo;
void fragment() { ALBEDO = texture(picture, vec2(SCREEN_UV.x, 1.0 - SCREEN_UV.y)).rgb; }
"""

var radar = Library.new()
var camera = Camera.new()
var pot = MeshInstance.new()
var moved = MeshInstance.new()
var room = []  # a MeshInstance per block
var picture = ImageTexture.new()
var picture_material = ShaderMaterial.new()
var colour_material = SpatialMaterial.new()
var shots = ""
var frames = 0


func _ready():
	var arguments = OS.get_cmdline_args()
	if arguments.size() < 2:
		return fail("usage: godot3-runner --path FOLDER -- MAP RECORDING [SHOTS]")
	shots = arguments[2] if arguments.size() > 2 else ""
	var poses_recorded = 2
	for fault in [radar.open(arguments[0], arguments[1], poses_recorded), radar.add("pot", "teapot", 0.0),
			radar.drop("pot", 0.3)]:
		if fault != "":
			return fail(fault)
	picture_material.shader = Shader.new()
	picture_material.shader.code = PICTURE_SHADER
	colour_material.vertex_color_use_as_albedo = true
	colour_material.flags_unshaded = true
	add_child(camera)
	camera.current = true
	add_background()
	for block in radar.blocks():
		add_block(block)
	pot.mesh = mesh_of(radar.object_mesh("pot"))
	pot.visible = false
	pot.material_override = SpatialMaterial.new()
	pot.material_override.albedo_color = Color(0.9, 0.55, 0.2)
	add_child(pot)
	moved.material_override = picture_material
	add_child(moved)
	var sun = DirectionalLight.new()
	sun.rotation_degrees = Vector3(-60, 30, 0)
	add_child(sun)


func fail(sentence):
	printerr("room.gd: ", sentence)
	set_physics_process(false)
	OS.exit_code = 1
	get_tree().quit(1)


# Returns a mesh of [vertices, normals, colours, indices, version].
func mesh_of(parts):
	var mesh = ArrayMesh.new()
	if parts == null:
		return mesh
	var colours = PoolColorArray()
	colours.resize(parts[0].size())
	for i in range(colours.size()):
		colours[i] = Color8(parts[2][3 * i], parts[2][3 * i + 1], parts[2][3 * i + 2])
	var arrays = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = parts[0]
	arrays[Mesh.ARRAY_NORMAL] = parts[1]
	arrays[Mesh.ARRAY_COLOR] = colours
	arrays[Mesh.ARRAY_INDEX] = parts[3]
	mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	return mesh


# Adds a block of the room: a mesh, and a body for Godot's own rays and bodies.
func add_block(parts):
	if parts == null:
		return
	var block = MeshInstance.new()
	block.mesh = mesh_of(parts)
	block.material_override = picture_material
	block.create_trimesh_collision()
	add_child(block)
	room.append(block)


# Adds a large square behind everything that shows the picture.
func add_background():
	var square = MeshInstance.new()
	square.mesh = QuadMesh.new()
	square.mesh.size = Vector2(200, 200)
	square.translation = Vector3(0, 0, -45)
	square.material_override = picture_material
	camera.add_child(square)


func transform_of(numbers):
	return Transform(Vector3(numbers[0], numbers[4], numbers[8]), Vector3(numbers[1], numbers[5], numbers[9]),
		Vector3(numbers[2], numbers[6], numbers[10]), Vector3(numbers[3], numbers[7], numbers[11]))


# Looks as the camera does.
func look():
	var view = radar.camera()
	if view == null:
		return
	var width = view[12]
	var height = view[13]
	var near = 0.05
	camera.transform = transform_of(view)
	camera.set_frustum(near * height / view[15],
		Vector2(near * (0.5 * (width - 1) - view[16]) / view[14], near * (view[17] - 0.5 * (height - 1)) / view[15]),
		near, 50.0)
	var image = Image.new()
	image.create_from_data(int(width), int(height), false, Image.FORMAT_RGB8, radar.picture())
	picture.create_from_image(image, 0)
	picture_material.set_shader_param("picture", picture)


func _physics_process(_delta):
	var outcome = radar.step()
	if outcome < 0:
		return fail(radar.error())
	if outcome == 0:
		set_physics_process(false)
		return finish()
	frames += 1
	look()
	moved.mesh = mesh_of(radar.moved())
	var state = radar.object("pot")
	pot.visible = state[12] == 1.0
	pot.transform = transform_of(state)


# Says where the pot lies, and what Godot's own ray finds below it.
func finish():
	var state = radar.object("pot")
	var at = transform_of(state).origin
	var hit = get_world().direct_space_state.intersect_ray(at + Vector3(0.3, 1.0, 0.0), at + Vector3(0.3, -2.0, 0.0))
	print("frames ", frames, " blocks ", room.size())
	print("pot ", at.x, " ", at.y, " ", at.z, " asleep ", state[13], " rests on ", state[14])
	print("ray ", hit.position.y if hit else "nothing")
	if shots == "":
		return
	yield(save_shot("picture.png"), "completed")
	for block in room:  # the room itself, from the side
		block.material_override = colour_material
	moved.visible = false
	camera.get_child(0).visible = false
	camera.look_at_from_position(at + Vector3(1.4, 1.1, 1.6), at, Vector3.UP)
	camera.set_perspective(60, 0.05, 50)
	yield(save_shot("room.png"), "completed")
	get_tree().quit()


func save_shot(name):
	for _i in range(3):
		yield(get_tree(), "idle_frame")
	yield(VisualServer, "frame_post_draw")
	var image = get_viewport().get_texture().get_data()
	image.flip_y()
	image.save_png(shots + "/" + name)
