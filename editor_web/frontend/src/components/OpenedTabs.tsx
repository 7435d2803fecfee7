/** Tabs whose bodies are made when they are first opened and keep what they show from then on. */
import { Tabs } from '@mantine/core'
import { useState, type ReactNode } from 'react'
import { Loading } from './Loading'

interface OpenedTabsProps {
  readonly label: string
  readonly bodies: Readonly<Record<string, ReactNode>>
  readonly className?: string
}

export function OpenedTabs({ label, bodies, className = '' }: OpenedTabsProps) {
  const names = Object.keys(bodies)
  const first = names[0] ?? ''
  const [tab, setTab] = useState(first)
  const [opened, setOpened] = useState<ReadonlySet<string>>(new Set([first]))

  function open(name: string | null): void {
    setTab(name ?? first)
    setOpened(new Set([...opened, name ?? first]))
  }

  return (
    <Tabs value={tab} onChange={open} className={`side-tabs ${className}`} keepMounted>
      <Tabs.List aria-label={label}>
        {names.map((name) => (
          <Tabs.Tab key={name} value={name}>
            {name}
          </Tabs.Tab>
        ))}
      </Tabs.List>
      {names.map((name) => (
        <Tabs.Panel key={name} value={name}>
          {opened.has(name) && (
            <Loading name={name}>{bodies[name]}</Loading>
          )}
        </Tabs.Panel>
      ))}
    </Tabs>
  )
}
