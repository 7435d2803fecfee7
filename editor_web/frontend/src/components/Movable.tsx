/** What keeps its state when it is placed elsewhere on the page, as another layout wants. */
import { useLayoutEffect, useRef, useState, type ReactNode } from 'react'
import { createPortal } from 'react-dom'
import classes from './Movable.module.css'

export interface Movable {
  /** To be drawn once, where it stays. */
  readonly source: ReactNode
  /** What `Placed` shows. */
  readonly host: HTMLElement
}

export function useMovable(content: ReactNode): Movable {
  const [host] = useState(() => {
    const element = document.createElement('div')
    element.className = classes.host ?? ''
    return element
  })
  return { source: createPortal(content, host), host }
}

/** Where it is now; `isHidden` keeps it in the document, for buttons elsewhere that submit its form. */
export function Placed({ host, isHidden = false }: { readonly host: HTMLElement; readonly isHidden?: boolean }) {
  const place = useRef<HTMLDivElement>(null)
  useLayoutEffect(() => place.current?.append(host), [host])
  return <div ref={place} className={classes.host} hidden={isHidden} />
}
