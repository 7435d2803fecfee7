/** Jogs with the sticks of a gamepad, as long as its deadman button is held. */
import { useEffect, useRef, useState } from 'react'
import type { Space } from '../../document/teaching'
import { heldPad, padVelocity, releasedPads } from './padJog'
import type { Jog } from './useJog'

const LOOK_MS = 40

interface PadJogProps {
  readonly isOn: boolean
  readonly jog: Jog
  readonly space: Space
  /** Of full speed. */
  readonly share: number
  readonly joints: number
  readonly obstacle: string | undefined
}

/** Returns whether a gamepad is there; browsers tell of one when a button of it is pressed. */
export function usePadJog({ isOn, jog, space, share, joints, obstacle }: PadJogProps): boolean {
  const [isThere, setThere] = useState(() => isAnyThere())
  const { held, hold, letGo } = jog
  // Those whose deadman button was seen up since the arm went: whoever has let go, for whatever reason, presses anew.
  const ready = useRef<ReadonlySet<number>>(new Set())

  useEffect(() => {
    const onChange = () => setThere(isAnyThere())
    const onGone = () => {
      onChange()
      if (isOn) letGo()
    }
    addEventListener('gamepadconnected', onChange)
    addEventListener('gamepaddisconnected', onGone)
    return () => {
      removeEventListener('gamepadconnected', onChange)
      removeEventListener('gamepaddisconnected', onGone)
    }
  }, [isOn, letGo])

  useEffect(() => {
    if (!isOn || held) return
    const look = setInterval(() => {
      const pads = navigator.getGamepads()
      const pad = heldPad(pads)
      const mayStart = obstacle === undefined && !document.hidden && document.hasFocus()
      const wasReady = pad !== undefined && ready.current.has(pad.index) && mayStart
      ready.current = new Set([...releasedPads(pads), ...(wasReady ? [pad.index] : [])])
      if (!wasReady || padVelocity(pad, space, share, joints).every((each) => each === 0)) return
      ready.current = new Set()
      hold('gamepad', () => {
        const now = heldPad(navigator.getGamepads())
        return now && padVelocity(now, space, share, joints)
      })
    }, LOOK_MS)
    return () => clearInterval(look)
  }, [isOn, held, hold, space, share, joints, obstacle])

  return isThere
}

function isAnyThere(): boolean {
  return navigator.getGamepads().some((pad) => pad?.connected)
}
