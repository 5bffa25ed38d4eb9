# Three axes that move with the pulses of their lines, as the kernel tells of them while they happen, and close the
# contacts at their low ends. Reads trace_pipe. Of each axis: the numbers of its step and direction line, whether those
# are inverted, how many steps it stands above its contact, and the file by which the contact's line is pulled.
function axis(step, direction, step_low, direction_low, position, contact) {
    axis_of[step] = axis_of[direction] = step
    direction_of[step] = direction
    inverted[step] = step_low
    inverted[direction] = direction_low
    position_of[step] = position
    contact_of[step] = contact
    level[step] = level[direction] = 0
}
BEGIN {
    axis(a + 0, a + 1, 0, 0, 240, contacts_x)
    axis(a + 3, a + 4, 1, 1, 160, contacts_y)
    axis(a + 6, a + 7, 0, 0, 300, contacts_z)
}
/gpio_value: [0-9]+ set/ {
    line = $(NF - 2)
    active = $NF != inverted[line]
    rises = active && !level[line]
    level[line] = active
    if (axis_of[line] != line || !rises) next
    position_of[line] += level[direction_of[line]] ? 1 : -1
    closed = position_of[line] <= 0
    if (closed == was_closed[line]) next
    was_closed[line] = closed
    print (closed ? "pull-up" : "pull-down") > contact_of[line]
    close(contact_of[line])
}
