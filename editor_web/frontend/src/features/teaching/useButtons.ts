/** Buttons of the keyboard and of gamepads on the bus; everything is let go when the page is left. */
import { useEffect, useRef } from 'react'
import { clearTeachRefusal, sendToServer, useDisabledReason } from '../../api/teaching'
import { padButtons, useButtonMap } from './buttonMap'
import { firstOfPath, nameOfPath } from '../../document/path'

const NOT_TYPED = new Set(['checkbox', 'radio', 'range', 'button'])

/** Whether a key means something else where it is pressed: text that is typed, a switch that is turned, a key that is chosen. */
function isMeant(target: EventTarget | null, code: string): boolean {
  if (!(target instanceof HTMLElement)) return false
  if (target.closest('.jog-keyboard, .key-cap') !== null) return true
  if (target instanceof HTMLInputElement) return !NOT_TYPED.has(target.type) || (target.type === 'checkbox' && code === 'Space')
  return target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement || target.isContentEditable
}

/** Listen, whatever is shown. */
export function useButtons(): void {
  const keys = useButtonMap((s) => s.keys)
  const obstacle = useDisabledReason()
  const isOn = useButtonMap((s) => s.isOn) && obstacle === undefined
  const pressed = useRef(new Set<string>())

  useEffect(() => {
    if (!isOn) return
    const held = pressed.current

    function send(source: string, button: string, value: boolean): void {
      const name = `${source}/${button}`
      if (held.has(name) === value) return
      if (value) {
        clearTeachRefusal('button')
        held.add(name)
      } else held.delete(name)
      useButtonMap.setState({ pressed: new Set(held) })
      sendToServer({ k: 'button', source, button, value })
    }

    function letGo(): void {
      for (const name of held) {
        send(firstOfPath(name), nameOfPath(name), false)
      }
    }

    function onKey(event: KeyboardEvent): void {
      const found = keys.find((each) => each.code === event.code)
      if (!found || (event.type === 'keydown' && isMeant(event.target, event.code)) || event.ctrlKey || event.metaKey || event.altKey)
        return
      event.preventDefault()
      // What the key does elsewhere, such as going to another tab, it does not while it is a button.
      event.stopPropagation()
      if (!event.repeat) send('keyboard', found.button, event.type === 'keydown')
    }

    let frame = 0
    function look(): void {
      // A button is down where it is on any gamepad; one that is gone has let go of everything.
      const down = padButtons(navigator.getGamepads())
      for (const button of down) send('gamepad', button, true)
      for (const name of held) {
        const button = nameOfPath(name)
        if (firstOfPath(name) === 'gamepad' && !down.has(button)) send('gamepad', button, false)
      }
      frame = requestAnimationFrame(look)
    }

    const onHidden = () => document.hidden && letGo()
    addEventListener('keydown', onKey, true)
    addEventListener('keyup', onKey, true)
    addEventListener('blur', letGo)
    document.addEventListener('visibilitychange', onHidden)
    look()
    return () => {
      removeEventListener('keydown', onKey, true)
      removeEventListener('keyup', onKey, true)
      removeEventListener('blur', letGo)
      document.removeEventListener('visibilitychange', onHidden)
      cancelAnimationFrame(frame)
      letGo()
    }
  }, [keys, isOn])
}
