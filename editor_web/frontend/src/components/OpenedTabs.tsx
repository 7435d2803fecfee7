/** Tabs whose bodies are made when they are first opened and keep what they show from then on. */
import { Tabs } from '@mantine/core'
import { useState, type ReactNode } from 'react'
import { Loading } from './Loading'

interface OpenedTabsProps {
  readonly label: string
  readonly bodies: Readonly<Record<string, ReactNode>>
  /** Do the tabs stand for the titles of the panels in them? */
  readonly isDock?: boolean
  /** Brings this tab to the front, each time that it is another object. */
  readonly asked?: { readonly tab: string } | undefined
}

export function OpenedTabs({ label, bodies, isDock = false, asked }: OpenedTabsProps) {
  const names = Object.keys(bodies)
  const first = names[0] ?? ''
  const [tab, setTab] = useState(asked?.tab ?? first)
  const [answered, setAnswered] = useState(asked)
  const [opened, setOpened] = useState<ReadonlySet<string>>(new Set([tab]))

  function open(name: string | null): void {
    setTab(name ?? first)
    setOpened(new Set([...opened, name ?? first]))
  }

  if (asked !== answered) {
    setAnswered(asked)
    if (asked && names.includes(asked.tab)) open(asked.tab)
  }

  return (
    <Tabs value={tab} onChange={open} data-dock={isDock || undefined} keepMounted>
      <Tabs.List aria-label={label}>
        {names.map((name) => (
          <Tabs.Tab key={name} value={name}>
            {name}
          </Tabs.Tab>
        ))}
      </Tabs.List>
      {names.map((name) => (
        <Tabs.Panel key={name} value={name}>
          {opened.has(name) && <Loading name={name}>{bodies[name]}</Loading>}
        </Tabs.Panel>
      ))}
    </Tabs>
  )
}
