---@meta calot
-- Generated from the API's table (src/lua/api_*.cpp, src/anatomy/scene_keys.cpp); the tests hold it to that. Do not edit.

---A place or a vector {x, y, z} in m, in the patient's frame: x to the patient's left, y towards the head,
---z out of the abdomen, from the navel.
---@alias calot.point number[]
---@alias calot.shape calot.shape_pear|calot.shape_sphere|calot.shape_swept|calot.shape_obj|calot.shape_tube|calot.shape_rigid|calot.shape_lobe

---An exercise: what a scenario returns.
---@class calot.exercise
---@field api number version of this interface: 2. In 1 parts of the score earn whether their steps were done or not, and any bail-out may complete; 1 to 2
---@field id string short name: small letters, digits and hyphens
---@field title string one line for people
---@field time_limit? number the session ends then at the latest; default 120 * s; 1 to 3600 s
---@field params? table<string, calot.param> what can be chosen when it is started: the p of scene, steps, demo and a score's function
---@field scene fun(p: table<string, any>): calot.scene returns the operating field
---@field steps fun(t: calot.Steps, p: table<string, any>) the operation's steps, a coroutine
---@field demo? fun(t: calot.Demo, p: table<string, any>) an expert's instrument path, a coroutine
---@field score? calot.weighted|fun(p: table<string, any>): calot.weighted what counts: calot.score.weighted { ... }, or function(p) that returns it; left out: a scene that trains nothing, and has no score
---@field golden? calot.golden when pictures are compared

---Something that can be chosen when the exercise is started (--param name=value).
---@class calot.param
---@field type "choice"|"number"|"boolean" what kind of value
---@field default any the value when nothing is chosen
---@field choices? string[] what can be chosen, for a choice
---@field min? number smallest number
---@field max? number largest number
---@field title? string one line for people

---Parts of the score; their weights sum to 1, the total is 0 to 100.
---@class calot.weighted
---@field critical? string[] events that cap the total and fail the exercise
---@field gates? calot.gate[] conditions that cap the total and fail the exercise
---@field cap? number the total's largest value after a critical event, or behind a gate; default 40; 0 to 100 points
---@field bail_out? fun(run: calot.Run): boolean, string, number[]? says whether bailing out was right, and why: then the steps that are left need not be done; left out: it never is
---@field bail_out_completes? boolean api 1: true: who bails out, at any time, may pass without the steps that are left; default false
---@field pass? number the total from which on the exercise is passed; default 80; 0 to 100 points
---@field [integer] calot.part

---A part of the score: { calot.score.benchmark { ... }, weight = 0.5 }.
---@class calot.part
---@field weight number its share of the total; 0 to 1
---@field name? string its name in the report; default the metric or the event
---@field steps? string[] the steps that it judges: it earns by the share of them that was done; left out: all
---@field [integer] calot.benchmark|calot.penalty|calot.procedure|calot.time_score|calot.critical_view|calot.rule

---A metric between a novice's value (no points) and an expert's (all points).
---@class calot.benchmark
---@field metric string the metric's name, such as "left.path_length_mm"
---@field novice number earns nothing, in the metric's unit
---@field expert number earns all, in the metric's unit

---Full marks, less a share for each event of a kind.
---@class calot.penalty
---@field event "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" the kind of event
---@field each? number share lost with each; default 0.25; 0 to 1

---Steps done less weighted errors: 100 steps done / steps - costs of each error, not below 0.
---@class calot.procedure
---@field steps? string[] the steps that earn; left out: all
---@field minor? string[] events that are minor errors
---@field minor_costs? number points of 100 that each of these costs; default 2; 0 to 100 points
---@field major? string[] events that are major errors
---@field major_costs? number points of 100 that each of these costs; default 10; 0 to 100 points

---The session's time, lengthened by errors, between a limit (no points) and a reference (all).
---@class calot.time_score
---@field reference number earns all; 0 to 3600 s
---@field limit number earns nothing; 0 to 3600 s
---@field errors? string[] events that lengthen it
---@field each? number by which each does; default 5 * s; 0 to 3600 s

---The points of the critical view of safety, as steps noted them.
---@class calot.critical_view
---@field metric? string the metric that holds its points; default "note.critical_view_points"
---@field satisfactory? number points from which on it is one; default 5; 0 to 100 points
---@field full? number points that earn all; default 6; 0.1 to 100 points

---A part that the author's own function judges.
---@class calot.rule
---@field judge fun(run: calot.Run): number, string, number[]? the function

---Caps the total, and fails the exercise, where all of its conditions hold: an event, one that came too early, a metric beyond a value. A metric that was never measured is beyond.
---@class calot.gate
---@field reason string one sentence for the trainee
---@field event? "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" this happened
---@field organ? string to this organ or tissue, or a piece of it
---@field only_after? "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" and this had not happened before
---@field after_organ? string to this organ or tissue, or a piece of it
---@field metric? string this metric is beyond a value
---@field below? number below this
---@field above? number above this
---@field unless? "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" an event that excuses it, such as bail_out
---@field cap? number the total's largest value then; left out: the score's; 0 to 100 points
---@field fails? boolean false: it caps the total, and does not fail the exercise; default true

---When pictures are compared with golden ones: at times, at moments, or at both; at most 100.
---@class calot.golden
---@field at? number[] times in s, within the time limit; a picture is of a hundredth of a second
---@field moments? calot.moment[] what happens, whenever that is

---A picture of something that happens: it stays the same picture where a demo takes another time.
---@class calot.moment
---@field name string the picture's
---@field step? string this step begins; with an event: that happens in this step
---@field event? "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" this happens
---@field organ? string to this organ or tissue, or a piece of it
---@field count? number the first of these events, the second, ...; default 1; 1 to 1000
---@field delay? number so long after it; default 0 * s; 0 to 3600 s

---Options of t:step.
---@class calot.step_options
---@field limit? number after it the step ends as timed out; 0.1 to 3600 s
---@field hint? string how it is done, shown to who practises and not in an exam
---@field force_on? string the instrument on whose jaws the step asks for a force from `least` to `most`: a page shows the band in its plot
---@field least? number of that force; 0 to 1000 N
---@field most? number of that force; 0 to 1000 N

---Options of t:critical_view.
---@class calot.critical_view_options
---@field gallbladder? string the organ's name; default "gallbladder"
---@field liver? string the organ's name; default "liver"
---@field plate? string the name of the tissue between the two; default "cystic_plate"
---@field neck? string a landmark, the triangle's corner at the gallbladder; default "cystic_duct.start"
---@field junction? string a landmark, its corner where the ducts meet; default "cystic_duct.end"
---@field hilum? string a landmark, its corner at the liver; default "common_duct.start"
---@field behind? calot.point a lens on the other side, {x, y, z} in m; left out: square to the triangle, 25 mm behind it, and the liver hides nothing
---@field lower_part? number of the gallbladder's way from neck to fundus that has to be off the plate; default 0.333333; 0 to 1
---@field near? number how far off the gallbladder a structure has to be free around; default 5 * mm; 0 to 50 mm
---@field one_from? number from this share on a criterion earns a point; default 0.6; 0 to 1
---@field two_from? number and from this on two; default 0.9; 0 to 1

---Options of motions.
---@class calot.move_options
---@field speed? number largest speed of the tip; default 30 * mm / s; 0.1 to 500 mm / s

---Options of a rotation.
---@class calot.rotate_options
---@field speed? number largest angular speed, rad/s; default 90 * deg; 1 to 1000 deg

---Options of t.laparoscope:look_at.
---@class calot.look_options
---@field distance? number from the lens to the place; default as the scene's laparoscope has it; 10 to 400 mm
---@field speed? number largest speed of the tip; default 30 * mm / s; 0.1 to 500 mm / s

---Options of an exchange.
---@class calot.exchange_options
---@field speed? number largest speed of the tip; default 150 * mm / s; 0.1 to 500 mm / s
---@field duration? number what an assistant takes to change one for the other; default 3 * s; 0 to 60 s

---Options of a motion that ends when a condition holds.
---@class calot.move_until_options
---@field along? calot.point direction, patient's frame, of any length; left out: along the shaft, into the body
---@field towards? string a landmark to move towards, instead of along
---@field speed? number largest speed of the tip; default 5 * mm / s; 0.1 to 500 mm / s
---@field limit? number how far the tip goes at most; default 20 * mm; 0.1 to 200 mm
---@field active? boolean true: current flows until the motion ends; only for what can be activated; default false

---Options of an approach.
---@class calot.approach_options
---@field speed? number largest speed of the tip; default 30 * mm / s; 0.1 to 500 mm / s
---@field depth? number how far into the tissue's rest the tip presses; negative stops before it; default 4 * mm; -20 to 20 mm
---@field offset? calot.point added to the landmark, patient's frame; default { 0, 0, 0 }
---@field clearance? number the last stretch is straight and this long; default 25 * mm; 0 to 100 mm
---@field jaw? number how far the jaws are open; default 60 * deg; 0 to 60 deg

---What scene = function(p) returns: the operating field at rest.
---@class calot.scene
---@field anatomy calot.anatomy organs and table: calot.anatomy(...) or a table
---@field ports? table<string, calot.point> trocars by name, added to the usual ones or moved: { name = { x, y, z } }
---@field instruments? table<string, calot.instrument> instruments by name: { left = { ... } }; they are t.left, ...
---@field laparoscope? calot.laparoscope the camera
---@field solver? calot.solver steps and tolerance

---The organs and how the table is tilted.
---@class calot.anatomy
---@field base? "standard"|"hydrops" named anatomy to start from; calot.anatomy(name) sets it
---@field organs? calot.organ[] the organs; with a base, the first overrides the base's first, and so on
---@field joints? calot.joint[] what ties organs to each other: where a duct grows out of a gallbladder
---@field tissue? calot.tissue[] connective tissue between organs, which may be dissected: the cystic plate
---@field leaves? calot.leaf[] peritoneum that is only seen: over the hepatoduodenal ligament
---@field ground? calot.ground[] shapes that stay and are touched
---@field support? calot.support a plane that carries the organs
---@field friction? number coefficient of friction of the organs on each other; 0 to 0.3 for wet tissue, uncalibrated; default 0; 0 to 1
---@field rest_within? number an organ that comes to rest further than this from where it is drawn is named in reports, and by calot check --build; default 10 * mm; 0 to 1000 mm
---@field heart_rate? number beats a minute, with which what bleeds pulses; default 70; 20 to 240
---@field table_head_up? number reverse Trendelenburg tilt; default 15 * deg; -60 to 60 deg
---@field table_left_down? number tilt to the patient's left; default 10 * deg; -60 to 60 deg

---A plane; what is below it is solid.
---@class calot.support
---@field point? calot.point a point on it; default { 0, 0, 0 }
---@field normal? calot.point its unit normal, pointing out of the solid; default { 0, 0, 1 }
---@field friction? number coefficient of friction of the skin on it; 0 to 0.3 for wet tissue; default 0; 0 to 1

---Ties a place on one organ to one on another: its end keeps its place and direction there.
---@class calot.joint
---@field from string "organ.landmark", the end that is tied
---@field to string "organ.landmark", what it is tied to
---@field radius? number of what is held at either side; default 4 * mm; 0.5 to 50 mm
---@field stiffness? number of all of it, N/m; default 2000; 1 to 1e+06

---Connective tissue: strands from one organ's surface to the nearest place of another's, slack until they are stretched. Pulled past their strength they give way one after another.
---@class calot.tissue
---@field name? string its name, unique; default "tissue"
---@field from string the organ whose surface it covers
---@field to string the organ that it hangs on
---@field within? number it is where their surfaces are nearer than this at rest; default 5 * mm; 0.1 to 40 mm
---@field start? number where it begins, as a share of a tube's length, or of the way from neck to fundus; default 0; 0 to 1
---@field stop? number where it ends; default 1; 0 to 1
---@field strands? number at most; how many share the area changes nothing but how finely it tears; default 100; 1 to 1500
---@field slack? number by which share of its length at rest a strand is longer; default 0.1; 0 to 3
---@field stiffness? number tension by area and strain as strands become taut; default 10 * kPa; 0.1 to 10000 kPa
---@field stiffening? number exponent of the tension a strain; 0: it does not stiffen; default 1.5; 0 to 20
---@field strength? number largest tension by area; uncalibrated; default 30 * kPa; 0.1 to 10000 kPa
---@field break_energy? number to tear it, J/m^2: as a peel's force by width, N/m; uncalibrated; default 150; 0.1 to 100000
---@field density? number kg/m^3; default 1000; 100 to 2000 kg/m^3
---@field radius? number of a strand, in its middle, as instruments feel it; 0: they pass through; uncalibrated; default 0.2 * mm; 0 to 2 mm
---@field divide_energy? number of an instrument's current that divides it, J/m^2; 1 mm of water takes 2.5e6 to boil away; uncalibrated; default 2.5e+06; 1000 to 1e+08
---@field covered? boolean true: a leaf of peritoneum covers it towards the front, to be seen, and opens where it is torn; default false
---@field looks? "fat"|"areolar" how its strands are drawn: as yellow lobules of fat, or as the loose tissue of a plane, whose fine fibres whiten as they are stretched; default "fat"

---A leaf of peritoneum over two tubes and what is between them, towards the front. It is seen, and carries nothing.
---@class calot.leaf
---@field from string the tube along which it lies
---@field to string the tube that it reaches over to
---@field start? number where it begins, as a share of the first tube's length; default 0; 0 to 1
---@field stop? number where it ends; default 1; 0 to 1
---@field free_edge? number how far it goes on past the first tube; default 2 * mm; 0 to 40 mm
---@field goes_on? number how far it goes on past the second tube; default 0 * mm; 0 to 40 mm

---A shape that stays and is touched. Instruments stop at it.
---@class calot.ground
---@field name? string its name, unique; default "ground"
---@field type? "plane"|"capsule"|"box" a plane (point, normal), a capsule (point, to, radius), a box with round edges (point, size, radius); default "plane"
---@field point? calot.point on the plane, a capsule's beginning, a box' centre; default { 0, 0, 0 }
---@field normal? calot.point the plane's unit normal, out of the solid; default { 0, 0, 1 }
---@field to? calot.point a capsule's end; default { 0, 0, 0 }
---@field size? calot.point a box' edges along x, y and z, without its rounding; default { 0, 0, 0 }
---@field radius? number of a capsule, and of a box' edges; default 5 * mm; 0.5 to 250 mm
---@field friction? number coefficient of friction of what touches it; default 0; 0 to 1
---@field looks? "usual"|"liver"|"bowel"|"fat"|"peritoneum"|"board"|"plastic" how it is drawn; usual: beside a lobe as peritoneum, else as liver, a plane as peritoneum; a bowel has to be a capsule; board and plastic are of a training box, whose walls are then around; default "usual"
---@field injury? string what it is called when it is hurt by blades, clips, current or a thrust; left out: liver and bowel by their looks, and nothing else
---@field thrust_limit? number the force of jaws, or of what a shaft ends in, that hurts it; uncalibrated; default 8 * N; 0.1 to 1000 N

---An instrument through a port.
---@class calot.instrument
---@field type? "atraumatic_grasper"|"bipolar_electrode"|"semm_forceps"|"maryland_dissector"|"l_hook"|"scissors"|"clip_applier"|"aspiration_needle" which instrument: atraumatic_grasper has long fenestrated jaws with teeth; bipolar_electrode (with channel) has no jaws and only pushes; semm_forceps has short broad flat jaws; maryland_dissector has slim curved jaws; l_hook is a wire that ends in a foot to one side, and has no jaws; scissors has blades; clip_applier has a shaft of 10 mm and sets clips; aspiration_needle is a needle of 14 gauge that draws out what a hollow organ holds, and has no jaws; default "atraumatic_grasper"
---@field port string the port it goes through
---@field waits? boolean true: it waits outside while another instrument is in its port, until it is exchanged for that; default false
---@field force_limit? number force on its jaws, or on what its shaft ends in, above which the event overforce is raised; default 8 * N; 0.05 to 100 N
---@field hand_force? number force at the tip up to which its hand holds it where it is commanded to be; beyond, it gives way; default 20 * N; 0.05 to 100 N
---@field port_friction? number friction of the seal of its port on the shaft that slides through, which its hand feels; 0.25 to 3 N; default 0.5 * N; 0 to 10 N
---@field pinch_force? number force that each jaw closes with: it stops where tissue carries that; jaws at an angle of 2 a hold a pull of 2 * pinch_force * (pad_friction * cos a - sin a), beyond which it slips; jaws only; default 6.8 * N; 0.05 to 100 N
---@field pad_friction? number coefficient of friction of a pad; 0.3 for semm_forceps; jaws only; default 0.8; 0.01 to 5
---@field friction? number coefficient of friction of the skin that the shaft and what it ends in press on; 0 to 0.3 for a smooth shaft on wet skin; default 0; 0 to 1
---@field power? number W of its current: what strands of tissue it touches then share it, and are divided by it; only what can be activated; default 30; 1 to 120
---@field clip? "M"|"ML" the size of its clips, for vessels of 2 to 4 mm (M) or 3.5 to 7 mm (ML); clip_applier only; default "ML"
---@field clips? number how many it carries; clip_applier only; default 8; 0 to 50
---@field bore? number its bore, across; 1.6 mm is 14 gauge; aspiration_needle only; default 1.6 * mm; 0.3 to 1.9 mm
---@field bore_length? number from its mouth to where the suction's pressure is; uncalibrated; aspiration_needle only; default 330 * mm; 20 to 1000 mm
---@field suction? number how far its pressure is below that outside of the organs; uncalibrated; aspiration_needle only; default 13 * kPa; 0 to 80 kPa
---@field pinhole? number across what stays open of a wall that it was through, 0: nothing; uncalibrated; aspiration_needle only; default 0.3 * mm; 0 to 2 mm

---The camera and its light.
---@class calot.laparoscope
---@field port? string the port it goes through; default "umbilical"
---@field angle? number of its optic: 0 or 30 deg are usual; default 30 * deg; 0 to 70 deg
---@field look_at? string landmark in the middle of the picture; default "gallbladder.fundus"
---@field distance? number from its tip to what it looks at; default 90 * mm; 10 to 400 mm
---@field field_of_view? number across the round picture; default 75 * deg; 20 to 120 deg
---@field light? number brightness of its light; 1: what it looks at is well lit; 0: it is off; default 1; 0 to 10
---@field exposure? number of the camera, which adapts to bright and dark pictures by itself; what it makes of them is then as bright as light times exposure; default 1; 0.05 to 20
---@field horizon? "level"|"held" who keeps it level: the camera, or who turns the shaft that it is fixed to; default "level"
---@field show_structure? boolean draw elements and nodes on the organs, to look into the simulation; default false

---How the simulation steps.
---@class calot.solver
---@field rate? number steps a second; default 50; 1 to 2000 steps a second
---@field motion? "static"|"dynamic" each step is a rest under its loads, or a time in which walls and bile move by their masses; default "static"
---@field tolerance? number dimensionless residual of equilibrium; default 1e-06; 1e-12 to 0.01
---@field skip_still? boolean do not compute again steps that change nothing; off only to measure what they cost; default true
---@field extensions? calot.extensions structural extensions at contacts

---Structural extensions: finer basis functions around each place that an instrument touches.
---@class calot.extensions
---@field levels? number subdivision levels added at a contact, each with 12 nodes; 0: none; default 0; 0 to 4
---@field view? number where the laparoscope looks at an organ from nearer than this it is refined too; 0: not; default 0 * mm; 0 to 400 mm
---@field scheme? "condensed"|"staged" solved together with the organ, or after it as its boundary allows (the 1997 scheme, to compare with); default "condensed"

---A hollow organ, a duct or vessel, a rigid thing, or a lobe of the liver. In calot.anatomy's overrides, only what differs.
---@class calot.organ
---@field name? string its name, unique; landmarks are written "gallbladder.fundus"; default "gallbladder"
---@field shape? calot.shape its shape at rest: type "pear", "sphere", "swept", "obj", "tube", "rigid", "lobe" with its keys
---@field nodes? number control nodes; more resolve finer folds and cost more; default 180; 12 to 1000
---@field neck? calot.point where the shape's lower pole lies; default { -50 * mm, 130 * mm, -110 * mm }
---@field fundus? calot.point where its upper pole points to; default { -80 * mm, 100 * mm, -60 * mm }
---@field liver_side? calot.point direction from the organ's axis to its bed on the liver; default { 0, 0.8, 0.6 }
---@field wall? calot.wall its wall
---@field bile? calot.bile what fills it
---@field held? calot.held[] elastic attachments; a list given here replaces the anatomy's own
---@field looks? "bile"|"pale"|"plastic" how a gallbladder is drawn: full of bile, or pale, as one that mucus has filled (hydrops); a rigid thing is a stone, or plastic; default "bile"
---@field extensions? boolean false: no structural extensions on this organ; default true
---@field compared_with? string another organ of the same shape; the metrics mean_difference_pct and largest_difference_pct then say how far this one's skin is from moving like that one's
---@field injury? calot.injury what it is called when this organ, which should be kept, is hurt
---@field keep_clear? number current that flows nearer to it is the event activation_beside; 0: it may; default 0 * mm; 0 to 100 mm
---@field vessels? calot.wall_vessel[] an artery's branches on a hollow organ's wall, drawn there, from which finer vessels grow

---A branch of an artery that is drawn on a wall: it looks, and does nothing.
---@class calot.wall_vessel
---@field points calot.point[] its course on the skin or near it, from where the artery comes: two points or more
---@field radius? number at its beginning; it tapers; default 0.5 * mm; 0.1 to 2 mm

---What an instructor calls an injury of this organ, such as "Strasberg E": the text of the event injury. What is left out is none.
---@class calot.injury
---@field cut? string it is divided
---@field closed? string a clip shuts it
---@field partly? string a clip holds a part of its width, or current goes through its wall
---@field unclipped? string it is divided without a shut clip on the patient's side
---@field near_start? calot.injury_near_start[] what cut and closed are called near a tube's start: of those that hold, the one that reaches least far
---@field together? calot.injury_together[] what cut, closed and unclipped are called where another organ is hurt too: the first that holds

---A part of a duct that has a class of its own, such as Strasberg's E2 instead of E1.
---@class calot.injury_near_start
---@field within number along it at rest, from its start: up to there; 0.1 to 200 mm
---@field called string what it is called there

---Injuries that have a class together, such as Strasberg's E5.
---@class calot.injury_together
---@field with string the other organ: it is divided, or a clip shuts it
---@field called string what it is called then, whichever was first

---The organ's wall.
---@class calot.wall
---@field thickness? number 2 to 3 mm is usual; default 2 * mm; 0.1 to 10 mm
---@field shear_modulus? number shear modulus mu of the isotropic wall at rest; default 100 * kPa; 1 to 100000 kPa
---@field stiffening? number b of the exponential Fung (Demiray) law; 0: neo-Hookean; default 0; 0 to 100
---@field fibres? calot.fibres makes the wall anisotropic; {}: as measured in human gallbladders, whose shear_modulus is 85 * kPa
---@field overstretch? number principal stretch above which the event overstretch is raised; default 2.2; 1.01 to 10
---@field perforation_stretch? number principal stretch above which a hollow organ's wall is opened: the event perforation; default 3; 1.01 to 20
---@field pinch_limit? number jaws that pinch harder open a hollow organ's wall: 15 to 37 N by jaw; default 15 * N; 0.5 to 100 N
---@field burn_energy? number J of current in one place that go through the wall; default 15; 0.1 to 1000
---@field density? number kg/m^3; 1050 is usual; 0: without weight and inertia; default 0; 0 to 2000 kg/m^3
---@field retardation? number how long stress lags behind a change of shape where motion is dynamic: it damps; default 0.005 * s; 0 to 1 s
---@field burn_reach? number current that flows nearer to it heats it, the more the nearer; 0: only where it is touched; uncalibrated; default 0.3 * mm; 0 to 5 mm
---@field raw_energy? number J/m^2 of current that leave a lobe's surface raw; 1 mm of water takes 2.5e6 to boil away; uncalibrated; default 2.5e+06; 10000 to 1e+09

---Two families of fibres (Holzapfel, Gasser, Ogden) on either side of the axis; they bear tension only.
---@class calot.fibres
---@field stiffness? number k1 of each family; each adds 4 k1 to Young's modulus along itself; default 48 * kPa; 0 to 100000 kPa
---@field stiffening? number exponent k2; 0: they do not stiffen; default 1; 0 to 1000
---@field angle? number from the axis, neck to fundus: 0 longitudinal, 90 * deg circumferential; default 0 * deg; 0 to 90 deg

---The filling. Give the volume or the pressure, the other follows; neither: the unstressed volume.
---@class calot.bile
---@field density? number kg/m^3; 1010 to 1040 is usual; default 1020; 500 to 2000 kg/m^3
---@field fill_volume? number volume of the filling; 0.5 to 1000 mL
---@field fill_pressure? number gauge pressure at the highest point; 10 to 15 mmHg is usual; 0 to 40 kPa

---An elastic foundation under the skin near a landmark: the cystic plate, the duct's root.
---@class calot.held
---@field name? string its name, unique within the organ; default "bed"
---@field landmark "neck"|"fundus"|"infundibulum"|"free_side"|"liver_side"|"body"|"bed"|"start"|"middle"|"end"|"centre"|"rim_1"|"rim_2"|"rim_3"|"rim_4"|"back"|"edge"|"underside"|"upper_side" the landmark it surrounds
---@field radius? number how far it reaches; default 10 * mm; 0.5 to 250 mm
---@field stiffness? number N/m per m^2 of skin; default 300000; 1 to 1e+10 N/m^3
---@field while_filled? boolean true: only until the organ is filled; then it is held by what it is tied to, such as tissue; default false

---A gallbladder: round fundus, tapering body, slim neck.
---@class calot.shape_pear
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "pear"; default "pear"
---@field length? number neck to fundus; 70 to 100 mm is usual; default 80 * mm; 30 to 250 mm
---@field width? number largest diameter; 30 to 40 mm is usual; default 35 * mm; 10 to 120 mm
---@field refine? number control nodes are closer by this factor near the fundus; default 1; 1 to 8
---@field refine_radius? number how far from the fundus they are; default 20 * mm; 1 to 250 mm

---A ball, as in the paper's experiments.
---@class calot.shape_sphere
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "sphere"; default "pear"
---@field radius? number radius at rest; default 20 * mm; 5 to 100 mm

---A hollow organ along a curved axis, such as a gallbladder with its pouch; its stations are its neck and its fundus too.
---@class calot.shape_swept
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "swept"; default "pear"
---@field along calot.station[] its axis from the neck's end to the fundus' end, two stations or more; the ends are rounded off

---A place on a swept organ's axis.
---@class calot.station
---@field at calot.point the place
---@field radius? number of the organ about its axis there; default 5 * mm; 1 to 60 mm
---@field refine? number control nodes are closer by this factor around it; default 1; 1 to 8

---A closed control mesh from a Wavefront OBJ file.
---@class calot.shape_obj
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "obj"; default "pear"
---@field path string file below the scenario's folder or the project's assets folder
---@field scale? number the file's coordinates times this are metres; default 1; 1e-09 to 1000
---@field turn? calot.point these are turned about this axis by its length first: { 0, 0, 90 * deg } about z; default { 0 * deg, 0 * deg, 0 * deg }
---@field offset? calot.point and then moved by this; default { 0, 0, 0 }
---@field axes? "organ"|"scene" along what these are: the organ's own axes, with its neck in the origin, +z towards its fundus and +x towards its liver side, or the scene's axes and origin; default "organ"
---@field through_points? boolean the wall passes through the file's points; without it they are control points, and the wall lies inside of them where it bulges; default false

---A duct or a vessel: a tube along a line; solid where its wall is as thick as its radius.
---@class calot.shape_tube
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "tube"; default "pear"
---@field points calot.point[] its middle at rest, from its start to its end: two points or more
---@field radius? number outer radius; default 2.5 * mm; 0.3 to 20 mm
---@field end_radius? number outer radius at its end; 0: as at its start; default 0 * mm; 0 to 20 mm
---@field radii? number[] instead of both: outer radii at each of its points, straight in between; other organs feel it everywhere as thick as where it is thickest
---@field nodes? number of its middle line; default 11; 5 to 60
---@field pressure? number gauge pressure of what it carries; default 0 * kPa; -10 to 40 kPa
---@field carries? "bile"|"blood" a duct's bile, or an artery's blood; default "bile"
---@field feed_pressure? number gauge pressure with which the patient feeds it where it is cut open; usually 12 kPa of blood, 1 kPa of bile; uncalibrated; 0 to 40 kPa
---@field feed_resistance? number of the way to where it is cut open, Pa s/m^3; usually such that an open cystic artery loses some 45 mL a minute, a cystic duct 3 of what the patient feeds, and 18 of a gallbladder's; uncalibrated; 0 to 1e+15
---@field patient_end? "held"|"start"|"end" the end that stays with the patient where it is divided: what is held, itself or by what it is tied to (its end where both ends are, or neither), or always the start or the end; default "held"

---A rigid thing, such as a stone: a box with round edges, a ball, a ring, or what an OBJ file holds.
---@class calot.shape_rigid
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "rigid"; default "pear"
---@field size? calot.point edges of the box without its rounding; { 0, 0, 0 }: a ball; default { 0, 0, 0 }
---@field rounding? number radius of its edges, of the ball, or of the rod that a ring is bent from; default 5 * mm; 0.5 to 50 mm
---@field ring? number radius of the circle in the middle of a ring about z; 0: it is no ring; default 0 * mm; 0 to 100 mm
---@field path? string a closed OBJ file below the scenario's folder or the project's assets folder
---@field scale? number the file's coordinates times this are metres; default 1; 1e-09 to 1000
---@field turn? calot.point it is turned about this axis by its length: { 90 * deg, 0, 0 } stands a ring up; default { 0 * deg, 0 * deg, 0 * deg }
---@field centre? calot.point where its middle is then; of a file, its origin; default { 0, 0, 0 }
---@field density? number kg/m^3; default 1500; 100 to 20000 kg/m^3
---@field stiffness? number a stone's is some 0.8 GPa, a lymph node's below 100 kPa; it strains alike everywhere; default 800000 * kPa; 10 to 1e+07 kPa

---A lobe of the liver, held at its back. Give it the neck, fundus and liver_side of the gallbladder in its bed.
---@class calot.shape_lobe
---@field type? "pear"|"sphere"|"swept"|"obj"|"tube"|"rigid"|"lobe" which shape: this one is "lobe"; default "pear"
---@field width? number across; default 140 * mm; 60 to 300 mm
---@field depth? number from its back to its edge; default 90 * mm; 40 to 200 mm
---@field thickness? number about, at its back; default 45 * mm; 15 to 120 mm
---@field edge? number thickness of its edge; default 9 * mm; 4 to 40 mm
---@field edge_angle? number between underside and upper side at its edge; default 40 * deg; 10 to 70 deg
---@field overhang? number by which the fundus stands out beyond its edge; default 16 * mm; -100 to 100 mm
---@field bed_length? number of the gallbladder whose bed it has; default 80 * mm; 30 to 250 mm
---@field bed_width? number of that gallbladder; 0: no bed; default 35 * mm; 0 to 120 mm
---@field bed_depth? number how deep the gallbladder lies in it; default 6.5 * mm; 0 to 40 mm
---@field young? number Young's modulus; 2 to 20 kPa were measured; default 6 * kPa; 0.5 to 1000 kPa
---@field poisson? number Poisson's ratio; beyond 0.45 the elements begin to lock; default 0.45; 0 to 0.47
---@field density? number kg/m^3; 1050 to 1060 is usual; 0: without weight and inertia; default 1060; 0 to 2000 kg/m^3
---@field capsule? number N/m of its capsule by stretch, once that is straight; 0: it has none; default 1800; 0 to 100000
---@field capsule_slack? number up to which its capsule is slack; default 1.25; 1 to 3
---@field sags? boolean true: its weight acts; false: as drawn it is in balance with its weight; default false
---@field hold? number of its back, N/m per m^2; default 1e+07; 1 to 1e+10 N/m^3

---Where an instrument touches, as contact returns it.
---@class calot.contact
---@field part "tip"|"jaws"|"shaft" the part that touches
---@field organ string the organ that it touches
---@field place calot.point the point that is pressed hardest, m
---@field landmark string the landmark nearest to it, such as "gallbladder.fundus"
---@field force number of the tissue on the whole part, N

---A clip on a tube, as clips returns it.
---@class calot.clip
---@field place number share of the tube's length from its start; 0 to 1
---@field opening number share of the tube's width that it does not hold; 0: it is shut; 0 to 1
---@field size "M"|"ML" the clip's size

---An event of a session, as a rule sees it.
---@class calot.event
---@field event "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" its kind
---@field time number when, s
---@field step string the step that ran
---@field instrument? string whose it is
---@field organ? string or tissue, that it happened to
---@field value? number as the kind says, in the unit that it says
---@field place? calot.point where, m
---@field cause? "scissors"|"current"|"clip"|"pinch"|"overstretch"|"opened"|"slipped"|"thrust" what did it
---@field text? string an injury's class; what was said at a time-out or a bail-out

---A step of a session, as a rule sees it.
---@class calot.step
---@field name string its name
---@field outcome "done"|"timeout"|"missed"|"bail_out"|"aborted" how it ended
---@field started number when it began, s
---@field ended number when it ended, s

---The hepatocystic triangle, by rays through it.
---@class calot.critical_view_triangle
---@field front number cleared of tissue, of what organs and instruments leave open to the laparoscope; 0 to 1
---@field behind number the same from behind; 0 to 1
---@field front_open number left open by organs and instruments to the laparoscope; below 0.1 nothing counts as cleared; 0 to 1
---@field behind_open number the same from behind; 0 to 1
---@field points number earned; 0 to 2

---The cystic plate on the gallbladder's lower part.
---@class calot.critical_view_plate
---@field share number of its strands there that are torn; 1 where there are none; 0 to 1
---@field points number earned; 0 to 2

---What enters the gallbladder.
---@class calot.critical_view_structures
---@field count number tubes joined to it that are not divided; 0 to 100
---@field free number of those what is seen and free around; 0 to 100
---@field points number earned; 0 to 2

---The critical view of safety, as critical_view returns it.
---@class calot.critical_view
---@field triangle calot.critical_view_triangle the hepatocystic triangle
---@field plate calot.critical_view_plate the cystic plate
---@field structures calot.critical_view_structures what enters the gallbladder
---@field points number earned; 0 to 6

---A strand of a tissue, as strands returns it.
---@class calot.strand
---@field from calot.point its end on the tissue's first organ
---@field middle calot.point its own middle
---@field to calot.point its end on the other organ
---@field share number of the first organ's way, where it begins: a tube's length, else from neck to fundus; 0 to 1
---@field tension number N; 0 while it is slack; 0 to 1e+06 N

---What steps and demo have in common. Instruments are its fields: t.left, t.right, ...; and t.laparoscope.
---@class calot.Session
local Session = {}

---Waits.
---@param duration number how long; 0 to 3600 s
function Session:wait(duration) end

---Waits until the predicate holds, or the step's limit has passed. Returns whether it held.
---@param predicate fun(): boolean asked after every simulated step
---@return boolean
function Session:wait_until(predicate) end

---Time since the start, s.
---@return number
function Session:time() end

---Pressure of the organ's filling at its highest point, gauge, Pa.
---@param organ string an organ's name
---@return number
function Session:pressure(organ) end

---Volume the organ encloses, m^3.
---@param organ string an organ's name
---@return number
function Session:volume(organ) end

---Share of a tissue's strands that are torn, 0 to 1; 1 as well where an organ that it held on to is gone.
---@param tissue string its name
---@return number
function Session:torn(tissue) end

---Surface of a liver's lobe that has lost its capsule to current until now, m^2.
---@param organ string an organ's name
---@return number
function Session:raw(organ) end

---Whether a tube, a duct or a vessel, has been divided. Its pieces then are organs of their own, "cystic_duct.patient" and "cystic_duct.specimen".
---@param organ string a tube's name
---@return boolean
function Session:divided(organ) end

---The clips on a tube, or on a piece of one, from its start to its end: each { place = a share of its length, opening = the share of its width that is not held, 0 where it is shut, size = "ML" }.
---@param organ string a tube's name
---@return calot.clip[]
function Session:clips(organ) end

---What has left the organs by openings until now, m^3: of one organ with its pieces, or of all. Not what was drawn out.
---@param liquid "bile"|"blood" which
---@param organ? string an organ of the scene; without it, all
---@return number
function Session:lost(liquid, organ) end

---Where a landmark is now on the skin, {x, y, z} in m.
---@param landmark string a landmark such as "gallbladder.fundus"
---@return calot.point
function Session:place(landmark) end

---A place on the middle of a tube, a duct or a vessel, now, and the direction from its start to its end there, of length 1: {x, y, z} each, the place in m.
---@param organ string a tube's name
---@param share number from its start, 0, to its end, 1; 0 to 1
---@return calot.point, number[]
function Session:along(organ, share) end

---How much of a triangle the laparoscope sees past organs and instruments, m^2, across its line of sight: from its edge it is seen as none.
---@param a calot.point a corner, {x, y, z} in m
---@param b calot.point the next
---@param c calot.point the last
---@return number
function Session:seen_area(a, b, c) end

---Whether the laparoscope sees a place: it is in the round picture, and no organ, instrument or ground lies before it. What is within 2 mm of it does not hide it.
---@param place calot.point|string a point, m, or a landmark such as "gallbladder.fundus"
---@return boolean
function Session:sees(place) end

---The critical view of safety as it is now, measured: the hepatocystic triangle cleared of tissue, by rays from the laparoscope and from behind; the plate's strands on the gallbladder's lower third torn; two structures and no more still enter the gallbladder, each seen and free. 0 to 2 points each, 0 to 6 in all; from which share on is uncalibrated.
---@param options? calot.critical_view_options what the parts are called, and what earns points
---@return calot.critical_view
function Session:critical_view(options) end

---The strands of a tissue that stand, as they lie now: none where an organ that it held on to is gone.
---@param tissue string its name
---@return calot.strand[]
function Session:strands(tissue) end

---The t of steps = function(t, p): the operation's steps, what to wait for, what to measure.
---@class calot.Steps: calot.Session
---@field [string] calot.Instrument
---@field laparoscope calot.Laparoscope
local Steps = {}

---Ends the running step as done and starts the next.
---@param name string short name, for metrics: letters, digits and _
---@param title string one line for people
---@param options? calot.step_options a limit in time, a hint
function Steps:step(name, title, options) end

---Ends the running step as missed: what it asks for can no longer be done. Nothing happens where its limit has ended it.
---@param why string in a few words, for people
function Steps:missed(why) end

---Waits until the predicate has held for a duration in all; metric <step>.<name>.time_in_s. Returns whether it did before the step's limit.
---@param name string short name, for the metric: letters, digits and _
---@param predicate fun(): boolean asked after every simulated step
---@param duration number time in all; 0.001 to 3600 s
---@return boolean
function Steps:hold(name, predicate, duration) end

---Puts a value into the report, its time and step with it. A number is the metric note.<name> too: its last value, to score by.
---@param name string its name: letters, digits and _
---@param value any a finite number, a text of up to 200 bytes, or true or false
---@param unit? string its unit, for people
function Steps:note(name, value, unit) end

---Divides a tube, a duct or a vessel, at about a share of its length (a mm or two off at most), not where a clip lies. Its pieces are organs of their own, "cystic_duct.patient" and "cystic_duct.specimen", each with the landmarks start, middle and end; the tube's patient_end says which is which. Returns their names, the patient's first, and the share where it was divided.
---@param organ string a tube's name
---@param share number from its start, 0, to its end, 1; 0 to 1
---@return string, string, number
function Steps:divide(organ, share) end

---Sets a clip that shuts a tube, a duct or a vessel, at about a share of its length: in a field that is prepared for a later step, as nobody sets it. Refused where a clip lies.
---@param organ string a tube's name
---@param share number from its start, 0, to its end, 1; 0 to 1
---@param size? "M"|"ML" the clip's; default ML
function Steps:clip(organ, share, size) end

---Takes an organ out of the field, with its joints. What asks for it later is told when and why it went.
---@param organ string an organ's name
---@param why? string such as "taken out"
function Steps:remove(organ, why) end

---Brings an organ into the field, where its definition has it; mesh files are not read here.
---@param organ calot.organ as in the scene's anatomy
function Steps:add(organ) end

---Lets an organ go where one of its held regions holds it, such as the assistant's hand at the fundus.
---@param organ string an organ's name
---@param held string the held region's name
function Steps:release(organ, held) end

---Lays the strands of a tissue between two organs where they are now.
---@param tissue calot.tissue as in the scene's anatomy
function Steps:add_tissue(tissue) end

---Takes a tissue out of the field, with all of its strands; t:torn says 1 of it then.
---@param tissue string its name
function Steps:remove_tissue(tissue) end

---Opens a hole in the wall of a tube at about a share of its length, not where a clip lies: a vessel bleeds there and a duct leaks, until clips or jaws shut it on both sides. Returns the share where it is.
---@param organ string a tube's name
---@param share number from its start, 0, to its end, 1; 0 to 1
---@param width? number across the hole; default 1 * mm; 0.1 to 10 mm
---@return number
function Steps:bleed(organ, share, width) end

---Ties a place on one organ to one on another where they are now.
---@param joint calot.joint as in the scene's anatomy
function Steps:tie(joint) end

---Undoes all joints of two organs.
---@param organ string an organ's name
---@param other string the other's name
function Steps:untie(organ, other) end

---How many events of a kind there have been, such as time_out; those of this step come before it.
---@param event "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" the kind of event
---@param organ? string only those of this organ or tissue, or a piece of it
---@return number
function Steps:count(event, organ) end

---What has happened so far, as the rules of a score see it.
---@return calot.event[]
function Steps:events() end

---The t of demo = function(t, p): moves the instruments.
---@class calot.Demo: calot.Session
---@field [string] calot.DemoInstrument
---@field laparoscope calot.DemoLaparoscope
local Demo = {}

---A time-out: the act of stopping to say what is seen. The event time_out has the words as its text.
---@param words? string what is said, up to 200 bytes
function Demo:time_out(words) end

---Ends the operation otherwise than planned: the session ends in this step, and is scored.
---@param how? string how, such as subtotal or convert, up to 200 bytes
function Demo:bail_out(how) end

---Runs functions side by side, one for each instrument say, until all have ended.
---@param first fun() runs side by side with the others
---@param second fun() runs side by side with the others
function Demo:together(first, second) end

---An instrument as steps see it: what it touches, holds and feels.
---@class calot.Instrument
local Instrument = {}

---Whether it holds the organ, or anything when none is named; grip says why not.
---@param organ? string an organ's name
---@return boolean
function Instrument:holds(organ) end

---Force of the tissue on it, N: on the whole instrument, or on the part named.
---@param part? "tip"|"jaws"|"shaft" shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip
---@return number
function Instrument:force(part) end

---The same with its direction, {x, y, z} in N, patient's frame.
---@param part? "tip"|"jaws"|"shaft" shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip
---@return number[]
function Instrument:force_vector(part) end

---How hard it is drawn along its shaft into the body, N: what it holds resists being drawn towards the port. 0 where it is pushed back.
---@param part? "tip"|"jaws"|"shaft" shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip
---@return number
function Instrument:pull(part) end

---How hard it is pushed back along its shaft, N: it presses into the tissue. 0 where it is drawn in.
---@param part? "tip"|"jaws"|"shaft" shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip
---@return number
function Instrument:push(part) end

---Force felt at its handle, N.
---@return number
function Instrument:handle_force() end

---The tissue's torque on it about its shaft, N m, above 0 where the tissue would turn it the way that a positive angle of rotate() does.
---@return number
function Instrument:torque() end

---Whether it touches tissue, or the part named does.
---@param part? "tip"|"jaws"|"shaft" shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip
---@return boolean
function Instrument:touching(part) end

---Whether it waits outside, while another instrument is in its port.
---@return boolean
function Instrument:waits() end

---Whether current flows in it. An error for an instrument without current.
---@return boolean
function Instrument:active() end

---How many clips it still carries. An error for an instrument without clips.
---@return number
function Instrument:clips_left() end

---What it has drawn out until now, m^3. An error for an instrument that draws nothing out.
---@return number
function Instrument:aspirated() end

---Where it touches, or the part named does, at the point that is pressed hardest; nil where it does not.
---@param part? "tip"|"jaws"|"shaft" shaft, jaws (without jaws: what the shaft ends in) or their foremost 5 mm, the tip
---@return calot.contact?
function Instrument:contact(part) end

---What its jaws are doing: "holding"; "open", or not yet closed; closed and "empty", with nothing between them; closed "beside" what they touch; or "slipped", after what they held slid off. It says why holds is false.
---@return string
function Instrument:grip() end

---Its tip's place, {x, y, z} in m.
---@return calot.point
function Instrument:tip() end

---How far its tip is from a landmark, m.
---@param landmark string a landmark such as "gallbladder.fundus"
---@return number
function Instrument:distance(landmark) end

---How far its jaws, or the electrode that it ends in, are from an organ's surface, m; 0 where they touch.
---@param organ string an organ's name
---@return number
function Instrument:clearance(organ) end

---An instrument as the demo moves it. Motions return when they have ended.
---@class calot.DemoInstrument: calot.Instrument
local DemoInstrument = {}

---Opens the jaws, if it has any, and goes to a landmark from outside, ending pressed onto the tissue, ready to close.
---@param landmark string a landmark such as "gallbladder.fundus"
---@param options? calot.approach_options how
function DemoInstrument:approach(landmark, options) end

---Opens the jaws. An error without jaws.
---@param angle? number angle between the jaws; default 60 * deg; 0 to 60 deg
function DemoInstrument:open(angle) end

---Closes the jaws on what is between them. An error without jaws.
function DemoInstrument:close() end

---Lets current flow for a while, and waits for that. An error for an instrument without current.
---@param duration number how long; 0.001 to 3600 s
function DemoInstrument:activate(duration) end

---Sets a clip on what is between its jaws. An error for an instrument without clips.
function DemoInstrument:fire() end

---Has it come in, where it waits outside while another one is in its port: that one is drawn back along its shaft, closed and taken out, and this one comes in closed and not turned, 30 mm deep, on the same way.
---@param options? calot.exchange_options how fast
function DemoInstrument:exchange(options) end

---Draws out what is behind the wall that its tip is pushed on, or is in, for a while, and waits for that. An error for an instrument that draws nothing out.
---@param duration number how long; 0.001 to 3600 s
function DemoInstrument:aspirate(duration) end

---Moves the tip straight to a place.
---@param target calot.point|string a point, m, or a landmark such as "gallbladder.fundus"
---@param options? calot.move_options how fast
function DemoInstrument:move_to(target, options) end

---Moves the tip straight by a vector, patient's frame.
---@param vector calot.point how far, {x, y, z} in m
---@param options? calot.move_options how fast
function DemoInstrument:move_by(vector, options) end

---Moves the tip straight on until the predicate holds, and stops there; the limit ends it too. Returns whether it held, and how far the tip went, m.
---@param predicate fun(): boolean asked after every simulated step
---@param options? calot.move_until_options where to
---@return boolean, number
function DemoInstrument:move_until(predicate, options) end

---Turns about the shaft.
---@param angle number right-handed about the direction of the tip; -360 to 360 deg
---@param options? calot.rotate_options how fast
function DemoInstrument:rotate(angle, options) end

---Waits.
---@param duration number how long; 0 to 3600 s
function DemoInstrument:wait(duration) end

---The laparoscope, t.laparoscope. With an angled optic it looks down from its shaft (posteriorly) where it starts, at roll 0; roll turns the way it looks about the shaft.
---@class calot.Laparoscope
local Laparoscope = {}

---The place of its lens, {x, y, z} in m.
---@return calot.point
function Laparoscope:tip() end

---The direction of its shaft into the body, of length 1.
---@return number[]
function Laparoscope:axis() end

---Where it looks, of length 1: along its shaft, or with an angled optic that angle off it.
---@return number[]
function Laparoscope:direction() end

---How far it is turned about its shaft from where it started, rad, right-handed about the way into the body.
---@return number
function Laparoscope:roll() end

---How far the picture's horizon is from level, rad, clockwise for who stands behind the camera. 0 unless the scene says horizon = "held".
---@return number
function Laparoscope:horizon() end

---Whether its end touched an organ when it was moved last.
---@return boolean
function Laparoscope:touching() end

---How far its lens is from a place, m.
---@param place calot.point|string a point, m, or a landmark such as "gallbladder.fundus"
---@return number
function Laparoscope:distance(place) end

---Where a place is in the picture, hidden or not: to the right and up from the middle, as shares of the round picture's radius (without the lens's slight barrel distortion). Nothing where it is not before the lens.
---@param place calot.point|string a point, m, or a landmark such as "gallbladder.fundus"
---@return number?, number?
function Laparoscope:picture(place) end

---The laparoscope as the demo moves it.
---@class calot.DemoLaparoscope: calot.Laparoscope
local DemoLaparoscope = {}

---Goes where a place is in the middle of the picture, with the optic down from the shaft.
---@param place calot.point|string a point, m, or a landmark such as "gallbladder.fundus"
---@param options? calot.look_options from how far, and how fast
function DemoLaparoscope:look_at(place, options) end

---Moves the lens straight to a place.
---@param target calot.point|string a point, m, or a landmark
---@param options? calot.move_options how fast
function DemoLaparoscope:move_to(target, options) end

---Moves the lens straight by a vector, patient's frame.
---@param vector calot.point how far, {x, y, z} in m
---@param options? calot.move_options how fast
function DemoLaparoscope:move_by(vector, options) end

---Turns about the shaft.
---@param angle number right-handed about the direction of the tip; -360 to 360 deg
---@param options? calot.rotate_options how fast
function DemoLaparoscope:rotate(angle, options) end

---A session that has ended, as a rule of the score sees it. metrics holds those that were measured by their names, notes what t:note gave last, params what was chosen, events and steps lists in the order of time.
---@class calot.Run
---@field events calot.event[]
---@field steps calot.step[]
---@field metrics table<string, number>
---@field notes table<string, number|string|boolean>
---@field params table<string, any>
local Run = {}

---How many events of a kind there were.
---@param event "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" the kind of event
---@param organ? string only those of this organ or tissue, or a piece of it
---@return integer
function Run:count(event, organ) end

---When there were events of a kind, s, ascending.
---@param event "contact"|"grasp"|"empty_grasp"|"release"|"slip"|"activation"|"overforce"|"overstretch"|"tear"|"parted"|"divided"|"dry_activation"|"clip"|"clip_dropped"|"cut"|"cut_unclipped"|"perforation"|"cut_liver"|"empty_cut"|"injury"|"activation_on_clip"|"activation_beside"|"time_out"|"bail_out"|"bile_leak"|"bleeding"|"leak_stopped"|"exchange"|"blocked_exchange"|"puncture"|"aspirated"|"empty_aspiration"|"clash"|"step_done"|"step_timeout"|"step_missed"|"raw_surface"|"turn" the kind of event
---@param organ? string only those of this organ or tissue, or a piece of it
---@return number[]
function Run:times(event, organ) end

---Multipliers to write figures with: 70 * mm, 12 * mmHg. Everything is in SI.
---@class calot.units
---@field mm number millimetre
---@field cm number centimetre
---@field m number metre
---@field mL number millilitre
---@field L number litre
---@field N number newton
---@field mN number millinewton
---@field Pa number pascal
---@field kPa number kilopascal
---@field MPa number megapascal
---@field mmHg number millimetre of mercury
---@field s number second
---@field ms number millisecond
---@field deg number degree
---@field rad number radian
---@field kg number kilogram
---@field g number gram

---@class calot.score
local score = {}

---The parts of the score.
---@param definition calot.weighted the parts
---@return calot.weighted
function score.weighted(definition) end

---Scores a metric between a novice's and an expert's value.
---@param definition calot.benchmark the metric and its two values
---@return calot.benchmark
function score.benchmark(definition) end

---Takes off a share for each event.
---@param definition calot.penalty the event
---@return calot.penalty
function score.penalty(definition) end

---Scores the steps that were done less errors by their severity.
---@param definition calot.procedure steps and errors
---@return calot.procedure
function score.procedure(definition) end

---Scores the session's time less penalties for errors.
---@param definition calot.time_score the times, and errors
---@return calot.time_score
function score.time(definition) end

---Scores the points of the critical view that steps noted.
---@param definition? calot.critical_view the metric and its points
---@return calot.critical_view
function score.critical_view(definition) end

---A part of the author's own; it needs a name. The function is asked when the session has ended, and whenever a recording is scored, in a Lua state of its own: it sees what was measured, and no world. It returns the share of the part that was earned, 0 to 1, the reason in a sentence, and the times (s) behind it.
---@param judge fun(run: calot.Run): number, string, number[]? judges a session
---@return calot.rule
function score.rule(judge) end

---@class calot
---@field units calot.units
---@field score calot.score
local calot = {}

---Declares the exercise; the scenario returns its result.
---@param definition calot.exercise the exercise
---@return calot.exercise
function calot.exercise(definition) end

---A named anatomy, with what differs in a table.
---@param name string the anatomy's name: standard, hydrops
---@param overrides? calot.anatomy what differs
---@return calot.anatomy
function calot.anatomy(name, overrides) end

---For modules: says as error() does that what was given to a function is wrong; calot check then says it too, where an error may only come of nothing having happened yet.
---@param message string what is wrong, and what is wanted
---@param level? number who is to blame: 1 who calls this, 2 who called that function, and so on; default 1; 1 to 20
function calot.refuse(message, level) end

return calot
