# The two interrupts of the link, entered straight from the vector table with all interrupts held off: in k0 the handler of
# the common entry, k0 and k1 free, everything else to be left as it was.
#
# They are assembly because they are taken up to 140,000 times a second each, both ways at 230,400 baud, and because each shifts
# what the other does by the time it takes: the common entry alone saves and restores more registers than these two need
# instructions. Registers by section of the chip's reference; the queues are logic/edges.rs and logic/runs.rs.

    .equ INTERRUPTS,    0xBF88
    .equ IFS0CLR,       0x1034
    .equ IFS1CLR,       0x1044
    .equ IEC1CLR,       0x1074
    .equ PORTC,         0x6090
    .equ LATB,          0x6060
    .equ LATGCLR,       0x61A4
    .equ TIMERS,        0xBF80
    .equ T4CONCLR,      0x0C04
    .equ TMR4,          0x0C10
    .equ PR4,           0x0C20

    .equ HEAD,          0
    .equ TAIL,          4
    .equ LEVEL,         8                   # of the edges
    .equ LOST,          12
    .equ EDGES,         16
    .equ EDGES_COUNT,   512
    .equ SENDING,       8                   # of the runs
    .equ RUNS,          12
    .equ RUNS_COUNT,    1024

    .section .text.link, "ax"

# Change notice: the time and the level of the link's input, RC13.
    .globl __enter_CHANGE_NOTICE
    .type __enter_CHANGE_NOTICE, @function
__enter_CHANGE_NOTICE:
    addiu   $sp, $sp, -16
    sw      $t0, 0($sp)
    mfc0    $t0, $9                         # Count
    sw      $t1, 4($sp)
    lui     $k1, INTERRUPTS
    lw      $t1, PORTC($k1)                 # the reading takes the cause away
    sw      $t2, 8($sp)
    li      $t2, 1
    sw      $t2, IFS1CLR($k1)               # IRQ 32
    ext     $t1, $t1, 13, 1
    ins     $t0, $t1, 0, 1                  # as Edge::packed
    lui     $k1, %hi({edges})
    addiu   $k1, $k1, %lo({edges})
    lw      $t2, LEVEL($k1)
    beq     $t1, $t2, 2f                    # another pin has changed
    sw      $t1, LEVEL($k1)
    lw      $t1, HEAD($k1)
    lw      $t2, TAIL($k1)
    subu    $t2, $t1, $t2
    sltiu   $t2, $t2, EDGES_COUNT
    beqz    $t2, 3f
    andi    $t2, $t1, EDGES_COUNT - 1
    sll     $t2, $t2, 2
    addu    $t2, $t2, $k1
    sw      $t0, EDGES($t2)
    addiu   $t1, $t1, 1
    sw      $t1, HEAD($k1)
1:  lw      $t0, 0($sp)
    lw      $t1, 4($sp)
    lw      $t2, 8($sp)
    addiu   $sp, $sp, 16
    eret

2:  lw      $t0, 0($sp)                     # the brush: on to the handler in k0
    lw      $t1, 4($sp)
    lw      $t2, 8($sp)
    j       __interrupt_entry
    addiu   $sp, $sp, 16

3:  li      $t0, 1                          # full: no more until the main program has emptied it
    sw      $t0, LOST($k1)
    lui     $k1, INTERRUPTS
    sw      $t0, IEC1CLR($k1)
    b       1b
    nop
    .size __enter_CHANGE_NOTICE, . - __enter_CHANGE_NOTICE

# Timer4: the next level of the link's output, RB7, and when to come again.
    .globl __enter_TIMER_4
    .type __enter_TIMER_4, @function
__enter_TIMER_4:
    addiu   $sp, $sp, -16
    sw      $t0, 0($sp)
    lui     $k1, %hi({runs})
    addiu   $k1, $k1, %lo({runs})
    sw      $t1, 4($sp)
    lw      $t0, TAIL($k1)
    lw      $t1, HEAD($k1)
    sw      $t2, 8($sp)
    beq     $t0, $t1, 2f
    andi    $t2, $t0, RUNS_COUNT - 1
    sll     $t2, $t2, 2
    addu    $t2, $t2, $k1
    lw      $t2, RUNS($t2)
    addiu   $t0, $t0, 1
    sw      $t0, TAIL($k1)
    lui     $k1, INTERRUPTS
    srl     $t1, $t2, 16                    # 4 = clear, 8 = set
    addu    $t1, $t1, $k1
    li      $t0, 1 << 7
    sw      $t0, LATB($t1)
    lui     $t1, TIMERS
    andi    $t2, $t2, 0xFFFF
    sw      $t2, PR4($t1)
    lw      $t0, TMR4($t1)
    sltu    $t0, $t2, $t0                   # so late that the period is over: else it would go on to 16 bits
    bnez    $t0, 3f
1:  lui     $t0, 1                          # IRQ 16
    sw      $t0, IFS0CLR($k1)
    lw      $t0, 0($sp)
    lw      $t1, 4($sp)
    lw      $t2, 8($sp)
    addiu   $sp, $sp, 16
    eret

2:  sw      $zero, SENDING($k1)             # nothing more: the line is high
    lui     $t1, TIMERS
    ori     $t0, $zero, 0x8000
    sw      $t0, T4CONCLR($t1)
    .if     {rs485}                         # the driver of the pair is off: RG2
    lui     $k1, INTERRUPTS
    li      $t0, 1 << 2
    sw      $t0, LATGCLR($k1)
    .endif
    b       1b
    lui     $k1, INTERRUPTS

3:  b       1b
    sw      $t2, TMR4($t1)
    .size __enter_TIMER_4, . - __enter_TIMER_4
