/** The jog panel of one arm, away from the page Teach: it keeps a connection of its own for as long as it is shown. */
import { useEffect } from 'react'
import { connectTeach, useTeach } from '../api/teaching'
import { JogPanel } from '../features/teaching/JogPanel'

export function JogHere({ arm }: { readonly arm: string }) {
  useEffect(connectTeach, [])
  const arms = useTeach((s) => s.arms)
  const info = arms?.find((each) => each.name === arm)
  if (arms === undefined) return <div role="status" aria-label="Loading" />
  return info ? <JogPanel key={arm} arm={info} /> : <p>The server does not tell how {arm} is jogged.</p>
}
