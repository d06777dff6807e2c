# Copies words from the probe's window to the place of the stub, and goes there. The programmer puts this program into RAM word
# by word, which is slow, and the stub through it, which is fast.
#
# From the probe: the number of words, then the words.

        lui     s3, 0xff20          # the window, where a load waits for the probe
        lui     a0, 0xa000
        ori     a0, a0, 0x0900      # the stub's place
        addu    t9, a0, zero
        lw      t5, 0(s3)
copy:   lw      t4, 0(s3)
        addiu   t5, t5, -1
        sw      t4, 0(a0)
        bne     t5, zero, copy
        addiu   a0, a0, 4           # in the delay slot, as every instruction after a branch
        jr      t9
        nop
