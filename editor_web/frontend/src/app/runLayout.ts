/** Which layout the page of a run has: what the address says, else what was chosen last in this browser. */
import { useState } from 'react'

export const LAYOUTS = ['operate', 'debug', '3d'] as const
export type RunLayout = (typeof LAYOUTS)[number]

const KEPT = 'flexcell.layout'
const IN_ADDRESS = 'layout'

/** The layout, and how another one is chosen. Without a 3D view there is only that for debugging. */
export function useRunLayout(hasView: boolean): readonly [RunLayout, (layout: RunLayout) => void] {
  const [chosen, setChosen] = useState<RunLayout | undefined>(() => layoutOf(location.search) ?? known(localStorage.getItem(KEPT)))
  const choose = (layout: RunLayout): void => {
    localStorage.setItem(KEPT, layout)
    history.replaceState(history.state, '', withLayout(location.href, layout))
    setChosen(layout)
  }
  return [hasView ? (chosen ?? 'operate') : 'debug', choose]
}

/** The layout that an address carries. */
export function layoutOf(search: string): RunLayout | undefined {
  return known(new URLSearchParams(search).get(IN_ADDRESS))
}

/** The address with this layout; the rest of it stays. */
export function withLayout(address: string, layout: RunLayout): string {
  const url = new URL(address)
  url.searchParams.set(IN_ADDRESS, layout)
  return url.href
}

function known(name: string | null): RunLayout | undefined {
  return LAYOUTS.find((each) => each === name)
}
